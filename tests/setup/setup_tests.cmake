# Output of the scripts while they set up and build. The installation is tested by hand: tests/setup/clean_machine.
add_test(NAME setup.build_output COMMAND ${PROJECT_SOURCE_DIR}/tests/setup/build_output)
set_tests_properties(setup.build_output PROPERTIES LABELS setup TIMEOUT 120)
