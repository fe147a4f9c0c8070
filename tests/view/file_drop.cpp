#include "tests/view/file_drop.h"

#include <X11/Xlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>

namespace meniscus::test {
namespace {

using namespace std::chrono_literals;

constexpr auto kPatience = 30s;
constexpr long kVersion = 5;

std::string uriOf(const std::filesystem::path& file) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string uri = "file://";
  for (const char c : std::filesystem::absolute(file).string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || c == '/' || c == '.' || c == '-' || c == '_') {
      uri += c;
    } else {
      uri += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
    }
  }
  return uri + "\r\n";
}

// The file manager.
class DragSource {
 public:
  DragSource(Display* display, Window target, std::string uris)
      : display_(display),
        target_(target),
        uris_(std::move(uris)),
        window_(XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0)) {
    XSetSelectionOwner(display_, atom("XdndSelection"), window_, CurrentTime);
  }
  ~DragSource() { XDestroyWindow(display_, window_); }
  DragSource(const DragSource&) = delete;
  DragSource& operator=(const DragSource&) = delete;

  std::string drop() {
    XWindowAttributes place{};
    XGetWindowAttributes(display_, target_, &place);
    Window child = 0;
    int x = 0, y = 0;
    XTranslateCoordinates(display_, target_, DefaultRootWindow(display_), place.width / 2, place.height / 2,
                          &x, &y, &child);
    send("XdndEnter", {kVersion << 24, static_cast<long>(atom("text/uri-list")), 0, 0});
    send("XdndPosition", {0, static_cast<long>(x) << 16 | y, static_cast<long>(CurrentTime),
                          static_cast<long>(atom("XdndActionCopy"))});
    const auto answer = waitFor("XdndStatus");
    if (!answer) return "the program does not say whether it takes files";
    if (((*answer)[1] & 1) == 0) return "the program takes no files";
    send("XdndDrop", {0, static_cast<long>(CurrentTime), 0, 0});
    return waitFor("XdndFinished") ? "" : "the program does not fetch the files";
  }

 private:
  using Data = std::array<long, 5>;

  Atom atom(const char* name) { return XInternAtom(display_, name, False); }

  void send(const char* type, const std::array<long, 4>& data) {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = target_;
    event.xclient.message_type = atom(type);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(window_);
    for (std::size_t i = 0; i < data.size(); ++i) event.xclient.data.l[i + 1] = data[i];
    XSendEvent(display_, target_, False, NoEventMask, &event);
    XFlush(display_);
  }

  // Meanwhile the program may ask for the names.
  std::unique_ptr<Data> waitFor(const char* type) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < end) {
      if (XPending(display_) == 0) {
        std::this_thread::sleep_for(5ms);
        continue;
      }
      XEvent event;
      XNextEvent(display_, &event);
      if (event.type == SelectionRequest) tellNames(event.xselectionrequest);
      if (event.type != ClientMessage || event.xclient.message_type != atom(type)) continue;
      auto data = std::make_unique<Data>();
      std::copy_n(event.xclient.data.l, data->size(), data->begin());
      return data;
    }
    return nullptr;
  }

  void tellNames(const XSelectionRequestEvent& request) {
    XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(uris_.data()), static_cast<int>(uris_.size()));
    XEvent event{};
    event.xselection.type = SelectionNotify;
    event.xselection.requestor = request.requestor;
    event.xselection.selection = request.selection;
    event.xselection.target = request.target;
    event.xselection.property = request.property;
    event.xselection.time = request.time;
    XSendEvent(display_, request.requestor, False, NoEventMask, &event);
    XFlush(display_);
  }

  Display* display_;
  Window target_;
  std::string uris_;
  Window window_;
};

}  // namespace

std::string dropFiles(const std::string& display, unsigned long window,
                      const std::vector<std::filesystem::path>& files) {
  const std::unique_ptr<Display, int (*)(Display*)> connection(XOpenDisplay(display.c_str()), &XCloseDisplay);
  if (!connection) return "there is no display " + display;
  std::string uris;
  for (const std::filesystem::path& file : files) uris += uriOf(file);
  return DragSource(connection.get(), window, std::move(uris)).drop();
}

}  // namespace meniscus::test
