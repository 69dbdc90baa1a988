# add_replayer(NAME): the replayer with all that it runs compiled into it, so that each has one compiler and one optimisation level throughout. Left out
# is what no replay or regrade runs: devices, rigs, authoring, simulated candidates, pictures.
function(add_replayer name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/engine/*.cpp ${CMAKE_SOURCE_DIR}/scenarios/*.cpp ${CMAKE_SOURCE_DIR}/grading/*.cpp)
  list(FILTER sources EXCLUDE REGEX "${CAVUM_APART}|/rig/|/engine/device/|/servo/(real_time|real_time_json|scheduling)\\.cpp|/tooth/(surface_patches|plant_lesion|periodontium|formula_tooth|make_[a-z]*)\\.cpp|/scenarios/(advice|candidate_device|check|cut_plan|edit_text|expert_time|live_exam|operator|picture|simulated_exam|template)\\.cpp|/grading/(close_exam|report)\\.cpp")
  add_executable(${name} ${CMAKE_SOURCE_DIR}/tests/replay/replayer.cpp ${sources} ${CMAKE_SOURCE_DIR}/engine/tooth/import/read_mesh.cpp
                 ${CMAKE_SOURCE_DIR}/engine/tooth/import/polygon_files.cpp)
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)  # a third of the time; bits must not depend on it either
  target_link_libraries(${name} PRIVATE cavum_flags PkgConfig::SODIUM PkgConfig::ZSTD PkgConfig::XXHASH PkgConfig::TOMLPP SQLite::SQLite3
                                        nlohmann_json::nlohmann_json muparser::muparser OpenMeshCore)
  target_include_directories(${name} SYSTEM PRIVATE ${OPENMESH_INCLUDE_DIRS})
  target_compile_definitions(${name} PRIVATE CAVUM_DATA_DIR="${CMAKE_SOURCE_DIR}/data")
endfunction()
