# Logs read by other people's readers.
add_executable(reference_log tests/reference/reference_log.cpp)
target_link_libraries(reference_log PRIVATE sandhopper_firmware sandhopper_plant)
set_target_properties(reference_log PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
add_test(NAME reference.mcap COMMAND ${PROJECT_SOURCE_DIR}/tests/reference/run ${CMAKE_BINARY_DIR})
set_tests_properties(reference.mcap PROPERTIES LABELS reference SKIP_RETURN_CODE 77 TIMEOUT 300)
