meniscus_test(NAME commands_test LABEL unit
  SOURCES error_panel_test.cpp option_values_test.cpp output_name_test.cpp render_options_test.cpp run_report_test.cpp style_test.cpp
  LIBRARIES meniscus_app nlohmann_json::nlohmann_json)
meniscus_test(NAME session_test LABEL unit
  SOURCES measurement_test.cpp panels_test.cpp session_test.cpp
  LIBRARIES meniscus_session)
