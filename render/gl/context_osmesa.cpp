// OSMesa: Mesa's software renderer without any window system. Removed from Mesa 25.1 and later, so it is
// opened at run time; its few declarations are repeated here from its documented interface (docs.mesa3d.org,
// OSMesa) instead of requiring a header that new systems lack.

#include <array>

#include "render/gl/context_backends.h"

namespace meniscus::gl {

namespace {

using OsmesaContext = void*;
constexpr int kOsmesaFormat = 0x22, kOsmesaRgba = 0x1908, kOsmesaDepthBits = 0x30, kOsmesaProfile = 0x33,
              kOsmesaCoreProfile = 0x34, kOsmesaMajor = 0x36, kOsmesaMinor = 0x37;
constexpr unsigned kUnsignedByte = 0x1401;

struct Osmesa {
  SharedLibrary library{"MENISCUS_OSMESA_LIBRARY", {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}};
  OsmesaContext (*createContextAttribs)(const int*, OsmesaContext) = nullptr;
  unsigned char (*makeCurrent)(OsmesaContext, void*, unsigned, int, int) = nullptr;
  void (*destroyContext)(OsmesaContext) = nullptr;
  ProcAddress getProcAddress = nullptr;

  Osmesa() {
    createContextAttribs = library.function<decltype(createContextAttribs)>("OSMesaCreateContextAttribs");
    makeCurrent = library.function<decltype(makeCurrent)>("OSMesaMakeCurrent");
    destroyContext = library.function<decltype(destroyContext)>("OSMesaDestroyContext");
    getProcAddress = library.function<ProcAddress>("OSMesaGetProcAddress");
  }
  bool complete() const { return createContextAttribs && makeCurrent && destroyContext && getProcAddress; }
};

class OsmesaOwner : public Context {
 public:
  OsmesaOwner(const Osmesa& api, OsmesaContext context) : api_(api), context_(context) {}
  ~OsmesaOwner() override {
    api_.makeCurrent(nullptr, nullptr, kUnsignedByte, 0, 0);
    api_.destroyContext(context_);
  }
  bool makeCurrent() { return api_.makeCurrent(context_, pixels_.data(), kUnsignedByte, kSide, kSide) != 0; }

 private:
  static constexpr int kSide = 4;  // its own image is never drawn to
  const Osmesa& api_;
  OsmesaContext context_;
  std::array<unsigned char, std::size_t{4} * kSide * kSide> pixels_{};
};

class OsmesaMaker : public ContextMaker {
 public:
  std::unique_ptr<Context> make(BackendReport& report) override {
    static const Osmesa api;
    report.name = "OSMesa";
    report.remedy = "install OSMesa (Debian: libosmesa6) or Mesa's EGL (Debian: libegl1 libgl1-mesa-dri)";
    if (!api.library.opened()) {
      report.reason = api.library.error();
      return nullptr;
    }
    if (!api.complete()) {
      report.reason = "the library lacks functions of OSMesa 11.2 or later";
      return nullptr;
    }
    const int attributes[] = {kOsmesaFormat,
                              kOsmesaRgba,
                              kOsmesaDepthBits,
                              24,
                              kOsmesaProfile,
                              kOsmesaCoreProfile,
                              kOsmesaMajor,
                              4,
                              kOsmesaMinor,
                              5,
                              0};
    OsmesaContext handle = api.createContextAttribs(attributes, nullptr);
    if (!handle) {
      report.reason = "it makes no OpenGL 4.5 core context";
      return nullptr;
    }
    auto context = std::make_unique<OsmesaOwner>(api, handle);
    if (!context->makeCurrent()) {
      report.reason = "its context cannot be made current";
      return nullptr;
    }
    report.reason = loadFunctions(api.getProcAddress);
    if (!report.reason.empty()) return nullptr;
    report.remedy.clear();
    return context;
  }
};

}  // namespace

std::unique_ptr<ContextMaker> osmesaMaker() {
  return std::make_unique<OsmesaMaker>();
}

}  // namespace meniscus::gl
