# A stride campaign as a job array on a real one-node Slurm.
if(TARGET hop)
  add_test(NAME slurm.array COMMAND ${PROJECT_SOURCE_DIR}/tests/slurm/run $<TARGET_FILE:hop>)
  set_tests_properties(slurm.array PROPERTIES LABELS slurm TIMEOUT 600 SKIP_RETURN_CODE 77)
endif()
