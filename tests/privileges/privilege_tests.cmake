# hopperd with no more than its own user, two capabilities, and no network.
add_executable(confine tests/privileges/confine.cpp)
add_executable(privilege_probe tests/privileges/probe.cpp)
foreach(program confine privilege_probe)
  target_compile_features(${program} PRIVATE cxx_std_20)
  set_target_properties(${program} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
endforeach()
# Not under sanitizers, which create sockets and threads of their own.
if(NOT SANDHOPPER_SANITIZE)
  add_test(NAME privileges.hopperd COMMAND ${PROJECT_SOURCE_DIR}/tests/privileges/run ${CMAKE_BINARY_DIR})
  set_tests_properties(privileges.hopperd PROPERTIES LABELS privileges SKIP_RETURN_CODE 77 TIMEOUT 120 RUN_SERIAL ON)
endif()
# Settings that the package makes on the robot's computer, tested on a folder that replaces "/".
add_test(NAME privileges.real_time COMMAND ${PROJECT_SOURCE_DIR}/tests/privileges/real_time)
set_tests_properties(privileges.real_time PROPERTIES LABELS privileges TIMEOUT 60)
add_test(NAME privileges.can_up COMMAND ${PROJECT_SOURCE_DIR}/tests/privileges/can_up)
set_tests_properties(privileges.can_up PROPERTIES LABELS privileges TIMEOUT 60)
