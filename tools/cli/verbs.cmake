# The verbs of `hop`, one line each. A verb is a program of its own, hop-NAME, from verb_NAME.cpp, SOURCES and LIBRARIES,
# so that the build of one verb needs nothing else. `hop` starts these programs.
set(SANDHOPPER_VERB_LINES "")
set(sandhopper_verb_programs "")

# Linked into every verb: parser, session, progress and main function.
add_library(sandhopper_cli STATIC
  tools/cli/arguments.cpp tools/cli/command_line.cpp tools/cli/output_folder.cpp tools/cli/program.cpp
  tools/cli/progress.cpp tools/cli/session.cpp tools/cli/verb.cpp ${PROJECT_BINARY_DIR}/generated/verbs.cpp)
target_link_libraries(sandhopper_cli PUBLIC sandhopper_config nlohmann_json::nlohmann_json fmt::fmt
                                     PRIVATE CLI11::CLI11)
sandhopper_precompile(sandhopper_cli <fmt/format.h> <nlohmann/json.hpp> <filesystem> <fstream>)

function(sandhopper_verb name summary)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "SOURCES;LIBRARIES")
  list(TRANSFORM arg_SOURCES PREPEND tools/cli/)
  sandhopper_program(hop-${name} SOURCES tools/cli/verb_${name}.cpp tools/cli/program_main.cpp ${arg_SOURCES}
                     LIBRARIES sandhopper_cli ${arg_LIBRARIES})
  get_target_property(options sandhopper_cli COMPILE_OPTIONS)
  target_compile_options(hop-${name} PRIVATE ${options})
  target_precompile_headers(hop-${name} REUSE_FROM sandhopper_cli)
  set(SANDHOPPER_VERB_LINES "${SANDHOPPER_VERB_LINES}      {\"${name}\", \"${summary}\", {}},\n" PARENT_SCOPE)
  set(sandhopper_verb_programs ${sandhopper_verb_programs} hop-${name} PARENT_SCOPE)
endfunction()

sandhopper_verb(calibrate "find zeros, gains and delays of the sensors, and write them down"
  SOURCES calibrate_encoders.cpp calibrate_imu.cpp calibrate_load_cell.cpp calibrate_timing.cpp calibrate_tof.cpp
          calibrate_torque_constant.cpp
  LIBRARIES sandhopper_calibrate)
sandhopper_verb(campaign "check or import recordings, or make a simulated campaign"
  SOURCES campaign_keys.cpp LIBRARIES sandhopper_campaign sandhopper_diagnose sandhopper_trial)
sandhopper_verb(conceal "make campaigns in which physics is hidden, to test 'hop diagnose'"
  LIBRARIES sandhopper_benchmark)
sandhopper_verb(config "check or show the configuration files"
  SOURCES config_kinds.cpp LIBRARIES sandhopper_firmware sandhopper_plant)
sandhopper_verb(diagnose "find the physics that a simulation lacks against recordings"
  SOURCES diagnose_effects.cpp LIBRARIES sandhopper_diagnose)
sandhopper_verb(doctor "say whether this machine can run the robot, and what to do if not"
  SOURCES doctor_bus.cpp doctor_config.cpp doctor_devices.cpp doctor_identity.cpp doctor_interrupts.cpp
          doctor_machine.cpp doctor_state.cpp
  LIBRARIES sandhopper_firmware)
sandhopper_verb(experiment "many simulated trials and what they say together"
  SOURCES experiment_beds.cpp experiment_next.cpp experiment_paper.cpp experiment_strides.cpp LIBRARIES sandhopper_experiment)
sandhopper_verb(explain "what a fault means and how to cure it, or what was measured around one"
  LIBRARIES sandhopper_explain)
sandhopper_verb(export "write a log as CSV, one row per cycle" LIBRARIES sandhopper_firmware sandhopper_trial)
sandhopper_verb(faults "break every device of the simulated robot in every phase, and judge the reaction"
  SOURCES faults_pairs.cpp LIBRARIES sandhopper_faults)
sandhopper_verb(recover "save what can be read of a cut or damaged log" LIBRARIES sandhopper_firmware)
sandhopper_verb(replay "run the cycle again on a log's frames and compare every output"
  SOURCES replay_trace.cpp LIBRARIES sandhopper_trial)
sandhopper_verb(report "make a trial's report page from its log" LIBRARIES sandhopper_report)
sandhopper_verb(terrain "say what a campaign of recordings tells about the ground"
  LIBRARIES sandhopper_terrain_analysis)
sandhopper_verb(trial "run hop trials and say how stiff the ground is"
  SOURCES series_prompts.cpp trial_runner.cpp LIBRARIES sandhopper_trial sandhopper_report)

configure_file(${PROJECT_SOURCE_DIR}/tools/cli/verbs.cpp.in ${PROJECT_BINARY_DIR}/generated/verbs.cpp @ONLY)
sandhopper_program(hop SOURCES tools/cli/main.cpp LIBRARIES sandhopper_cli)
