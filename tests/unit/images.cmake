meniscus_test(NAME images_test LABEL unit
  SOURCES environment_file_test.cpp image_writer_test.cpp output_file_test.cpp ${PROJECT_SOURCE_DIR}/tests/support/process.cpp
  LIBRARIES meniscus_io OpenImageIO::OpenImageIO)
