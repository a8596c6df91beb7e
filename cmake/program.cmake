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

file(GLOB BURR_SAMPLES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/samples/s[0-9]*.cpp)
foreach(sample ${BURR_SAMPLES})
  get_filename_component(name ${sample} NAME_WE)
  add_executable(${name} ${sample})
  target_link_libraries(${name} PRIVATE burr burr_scenes burr_options fmt::fmt)
endforeach()
