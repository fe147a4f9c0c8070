meniscus_test(NAME structures_test LABEL unit
  SOURCES assembly_test.cpp binary_cif_test.cpp bonds_test.cpp elements_test.cpp guess_element_test.cpp molecule_files_test.cpp ribbon_test.cpp
          secondary_structure_test.cpp
          structure_errors_test.cpp structure_options_test.cpp structure_reader_test.cpp
  LIBRARIES meniscus_io meniscus_gemmi nlohmann_json::nlohmann_json)
