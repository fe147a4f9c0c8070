meniscus_test(NAME generated_scenes_test LABEL unit CALCULATES
  SOURCES generated_scenes_test.cpp
  LIBRARIES meniscus_core meniscus_test_scenes)
meniscus_test(NAME measure_test LABEL unit
  SOURCES measure_test.cpp ${PROJECT_SOURCE_DIR}/tests/support/process.cpp
  LIBRARIES meniscus_app)
