# What the scripts show while they set up and build. Installing itself: tests/setup/clean_machine, by hand.
add_test(NAME setup.build_output COMMAND ${PROJECT_SOURCE_DIR}/tests/setup/build_output)
set_tests_properties(setup.build_output PROPERTIES LABELS setup TIMEOUT 120)
