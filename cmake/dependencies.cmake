# Everything that is not ours. scripts/install-dependencies names the Debian package of each.
find_package(ZLIB REQUIRED)       # zlib1g-dev: .gz input (through gemmi), PNG
find_package(PNG REQUIRED)        # libpng-dev
find_package(OpenEXR CONFIG REQUIRED)  # libopenexr-dev
find_package(fmt REQUIRED)        # libfmt-dev
find_package(nlohmann_json REQUIRED)   # nlohmann-json3-dev
find_package(CLI11 REQUIRED)      # libcli11-dev
# libzip-dev: scene archives; its own CMake file wants the package of its tools, too.
find_path(LIBZIP_INCLUDE_DIR zip.h REQUIRED)
find_library(LIBZIP_LIBRARY zip REQUIRED)
find_package(Freetype REQUIRED)   # libfreetype-dev: labels
find_package(CURL REQUIRED)       # libcurl4-openssl-dev: what scenes refer to on the web
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)  # libxxhash-dev: names of contents; used as a header
find_package(TBB REQUIRED)        # libtbb-dev: core/tiles on all processors
find_package(TinyGLTF CONFIG REQUIRED)  # libtinygltf-dev: surfaces as .glb
# libstb-dev: pictures of environments; Debian's Dear ImGui takes its font rasterizer from there, too
find_path(STB_INCLUDE_DIR stb_image.h PATH_SUFFIXES stb REQUIRED)
find_library(STB_LIBRARY stb REQUIRED)
add_library(meniscus_stb INTERFACE)
target_include_directories(meniscus_stb SYSTEM INTERFACE ${STB_INCLUDE_DIR})
target_link_libraries(meniscus_stb INTERFACE ${STB_LIBRARY})
find_package(hwy REQUIRED)        # libhwy-dev: vectors of the instruction set that the processor has

find_path(GEMMI_INCLUDE_DIR gemmi/mmread.hpp REQUIRED)  # gemmi-dev: header only in 0.5
find_path(PEGTL_INCLUDE_DIR tao/pegtl.hpp REQUIRED)  # tao-pegtl-dev: gemmi/cif.hpp includes it
add_library(meniscus_gemmi INTERFACE)
target_include_directories(meniscus_gemmi SYSTEM INTERFACE ${GEMMI_INCLUDE_DIR})
target_link_libraries(meniscus_gemmi INTERFACE ZLIB::ZLIB)

find_path(GLM_INCLUDE_DIR glm/glm.hpp REQUIRED)
add_library(meniscus_glm INTERFACE)
target_include_directories(meniscus_glm SYSTEM INTERFACE ${GLM_INCLUDE_DIR})

# python3-glad; /usr/bin/python3 because the first python3 on the PATH may not be the one that has Debian's modules.
find_program(GLAD_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)
find_path(EGL_INCLUDE_DIR EGL/egl.h REQUIRED)  # libegl-dev: declarations only, the library is opened at run time

find_package(Threads REQUIRED)
if(MENISCUS_VIEWER)
  find_package(glfw3 REQUIRED)  # libglfw3-dev
  # libimgui-dev: Dear ImGui with its back ends for GLFW and OpenGL 3
  find_path(IMGUI_INCLUDE_DIR imgui.h PATH_SUFFIXES imgui REQUIRED)
  find_library(IMGUI_LIBRARY imgui REQUIRED)
  add_library(meniscus_imgui INTERFACE)
  target_include_directories(meniscus_imgui SYSTEM INTERFACE ${IMGUI_INCLUDE_DIR})
  target_link_libraries(meniscus_imgui INTERFACE ${IMGUI_LIBRARY} ${STB_LIBRARY} glfw Freetype::Freetype ${CMAKE_DL_LIBS})
endif()
