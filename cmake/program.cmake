# the program `burr`: one file per subcommand
file(GLOB_RECURSE BURR_APP CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/apps/burr/*.cpp)
if(BURR_APP)
  add_executable(burr_program ${BURR_APP})
  set_target_properties(burr_program PROPERTIES OUTPUT_NAME burr RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
  target_include_directories(burr_program PRIVATE ${PROJECT_SOURCE_DIR}/apps/burr)
  target_link_libraries(burr_program PRIVATE burr burr_scenes burr_options CLI11::CLI11 fmt::fmt spdlog::spdlog
    nlohmann_json::nlohmann_json PkgConfig::EPOXY PkgConfig::SDL2 PkgConfig::IMGUI)
  target_include_directories(burr_program PRIVATE ${PROJECT_SOURCE_DIR}/third_party)
  target_compile_definitions(burr_program PRIVATE BURR_VERSION="${PROJECT_VERSION}")
  burr_common_headers(burr_program <fmt/format.h> <nlohmann/json.hpp>)
  burr_glue(burr_program)
  if(BURR_WARNINGS_ONLY)
    target_compile_options(burr_program PRIVATE -O0)
  else()  # holds the yardstick of `burr bench tick`, which is compiled as the library is
    set_source_files_properties(${PROJECT_SOURCE_DIR}/apps/burr/bench_tick.cpp PROPERTIES
      COMPILE_OPTIONS "$<$<CONFIG:Release>:-O3>" SKIP_PRECOMPILE_HEADERS ON)
  endif()
endif()

# The bones of the built-in cases, shaped once here: their formulas take seconds (apps/burr/ready_bone.h).
# Not where a sanitizer watches: there it takes minutes, and the program falls back on the formula.
if(BURR_APP AND NOT BURR_SANITIZE AND NOT BURR_WARNINGS_ONLY)
  foreach(phantom temporal-bone jaw tooth spine)
    set(bone ${CMAKE_BINARY_DIR}/bones/${phantom}.bone)
    add_custom_command(OUTPUT ${bone}
      COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/bones
      COMMAND burr_program phantom ${phantom} --out ${bone} > ${CMAKE_BINARY_DIR}/bones/${phantom}.txt 2>&1
      DEPENDS $<TARGET_FILE:burr_scenes> COMMENT "Shaping ${phantom}" VERBATIM)
    list(APPEND BURR_BONES ${bone})
  endforeach()
  add_custom_target(burr_bones ALL DEPENDS ${BURR_BONES})
endif()

file(GLOB BURR_SAMPLES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/samples/s[0-9]*.cpp)
foreach(sample ${BURR_SAMPLES})
  get_filename_component(name ${sample} NAME_WE)
  add_executable(${name} ${sample})
  target_link_libraries(${name} PRIVATE burr burr_scenes burr_options fmt::fmt)
endforeach()
