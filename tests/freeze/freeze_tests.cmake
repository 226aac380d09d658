# Freeze frames: the ring, the frames written from it, the frame of every fault, and its text. A separate program, because it
# needs only a small part of the project.
file(GLOB freeze_test_sources CONFIGURE_DEPENDS tests/freeze/*.cpp)
add_executable(freeze_tests ${freeze_test_sources} tests/unit/allocation_guard.cpp)
target_link_libraries(freeze_tests PRIVATE sandhopper_faults sandhopper_explain GTest::gmock GTest::gtest_main)
target_compile_definitions(freeze_tests PRIVATE SANDHOPPER_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
set_target_properties(freeze_tests PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
gtest_discover_tests(freeze_tests DISCOVERY_TIMEOUT 60 NO_PRETTY_VALUES PROPERTIES LABELS freeze)
# hopperd killed at random instants while it hops; SANDHOPPER_KILLS says how often.
add_test(NAME freeze.killed COMMAND ${PROJECT_SOURCE_DIR}/tests/freeze/killed ${CMAKE_BINARY_DIR})
set_tests_properties(freeze.killed PROPERTIES LABELS freeze TIMEOUT 300 RUN_SERIAL ON)
add_test(NAME freeze.full_disk COMMAND ${PROJECT_SOURCE_DIR}/tests/freeze/full_disk ${CMAKE_BINARY_DIR})
set_tests_properties(freeze.full_disk PROPERTIES LABELS freeze TIMEOUT 120 SKIP_RETURN_CODE 77)
