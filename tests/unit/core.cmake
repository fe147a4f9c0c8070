meniscus_test(NAME core_test LABEL unit
  SOURCES ambient_field_test.cpp atom_colors_test.cpp camera_fit_test.cpp displacement_test.cpp hit_errors_test.cpp metaball_field_test.cpp primitives_test.cpp reference_tracer_test.cpp sampling_test.cpp surface_method_test.cpp
          view_test.cpp
  LIBRARIES meniscus_render meniscus_core)
meniscus_test(NAME tiles_test LABEL unit CALCULATES COST 55 SOURCES tiles_test.cpp detail_levels_test.cpp tile_cells_test.cpp tile_copies_test.cpp
              LIBRARIES meniscus_core meniscus_test_scenes)
meniscus_test(NAME field_tiles_test LABEL unit CALCULATES SOURCES field_tiles_test.cpp LIBRARIES meniscus_core)
meniscus_test(NAME surface_mesh_test LABEL unit CALCULATES SOURCES surface_mesh_test.cpp LIBRARIES meniscus_core)
find_package(assimp REQUIRED)  # an outside opinion on the files
meniscus_test(NAME mesh_file_test LABEL unit SOURCES mesh_file_test.cpp LIBRARIES meniscus_io assimp::assimp)
meniscus_test(NAME bvh_test LABEL unit CALCULATES SOURCES bvh_test.cpp LIBRARIES meniscus_core TBB::tbb)
meniscus_test(NAME traced_light_test LABEL unit CALCULATES
  SOURCES traced_light_test.cpp LIBRARIES meniscus_core meniscus_test_scenes)
