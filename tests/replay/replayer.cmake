# add_replayer(NAME): the replayer with all that it runs compiled into it, so that each has one compiler and one optimisation level throughout: the room
# `grading` and those below it.
function(add_replayer name)
  set(rooms grading)
  set(sources ${CMAKE_SOURCE_DIR}/tests/replay/replayer.cpp)
  while(rooms)
    list(POP_FRONT rooms room)
    list(APPEND seen ${room})
    get_property(own GLOBAL PROPERTY CAVUM_ROOM_${room}_SOURCES)
    get_property(below GLOBAL PROPERTY CAVUM_ROOM_${room}_ROOMS)
    list(APPEND sources ${own})
    list(APPEND rooms ${below})
    list(REMOVE_DUPLICATES rooms)
    list(REMOVE_ITEM rooms ${seen})
  endwhile()
  add_executable(${name} ${sources})
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)  # a third of the time; bits must not depend on it either
  # at other levels and for other machines g++ 12 mistakes std::string, std::vector and OpenMesh for full, overlapping or unset memory (GCC bug 105651 and others)
  target_compile_options(${name} PRIVATE "$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-stringop-overflow;-Wno-array-bounds;-Wno-stringop-overread;-Wno-maybe-uninitialized>")
  target_link_libraries(${name} PRIVATE cavum_flags PkgConfig::SODIUM PkgConfig::ZSTD PkgConfig::XXHASH PkgConfig::TOMLPP SQLite::SQLite3
                                        nlohmann_json::nlohmann_json fmt::fmt muparser::muparser OpenMeshCore)
  target_include_directories(${name} SYSTEM PRIVATE ${OPENMESH_INCLUDE_DIRS})
endfunction()
