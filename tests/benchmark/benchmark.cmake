# Timings, run by hand: build/bin/benchmarks --benchmark_filter=…
find_package(benchmark REQUIRED)
file(GLOB benchmark_sources CONFIGURE_DEPENDS tests/benchmark/*.cpp)
add_executable(benchmarks ${benchmark_sources})
target_link_libraries(benchmarks PRIVATE sandhopper_firmware sandhopper_plant benchmark::benchmark_main)
set_target_properties(benchmarks PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
