# hopperd's log on a disk that is slow, full, or turns read-only.
add_executable(faulty_disk tests/disk/faulty_disk.cpp)
target_link_libraries(faulty_disk PRIVATE sandhopper_options PkgConfig::FUSE3)
set_target_properties(faulty_disk PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
add_test(NAME disk.log_survives COMMAND ${PROJECT_SOURCE_DIR}/tests/disk/run ${CMAKE_BINARY_DIR})
set_tests_properties(disk.log_survives PROPERTIES LABELS disk SKIP_RETURN_CODE 77 TIMEOUT 300 RUN_SERIAL ON)
