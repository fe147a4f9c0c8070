meniscus_test(NAME scenes_test LABEL unit
  SOURCES fetch_test.cpp scene_errors_test.cpp scene_reader_test.cpp ${PROJECT_SOURCE_DIR}/tests/support/process.cpp
  LIBRARIES meniscus_app nlohmann_json::nlohmann_json ${LIBZIP_LIBRARY})
