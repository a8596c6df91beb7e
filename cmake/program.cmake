# the program `burr`: one file per subcommand
file(GLOB_RECURSE BURR_APP CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/apps/burr/*.cpp)
if(BURR_APP)
  # burr_of_program(TARGET): what all that is compiled of it have in common
  function(burr_of_program target)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/apps/burr ${PROJECT_SOURCE_DIR}/third_party)
    target_link_libraries(${target} PRIVATE burr burr_scenes burr_options CLI11::CLI11 fmt::fmt spdlog::spdlog
      nlohmann_json::nlohmann_json PkgConfig::EPOXY PkgConfig::SDL2 PkgConfig::IMGUI)
    target_compile_definitions(${target} PRIVATE BURR_VERSION="${PROJECT_VERSION}")
    burr_common_headers(${target} <fmt/format.h> <nlohmann/json.hpp>)
    burr_glue(${target})
    if(BURR_WARNINGS_ONLY)
      target_compile_options(${target} PRIVATE -O0)
    endif()
  endfunction()

  # the parts that tests look at as well, compiled once: the window, the doctor, what both stand on
  set(BURR_APP_PARTS commands/html_page
    devices/trial devices/trial_words doctor/apart doctor/devices_there doctor/finding doctor/fix doctor/nodes)
  list(TRANSFORM BURR_APP_PARTS REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/apps/burr/\\1.cpp")
  file(GLOB_RECURSE window_and_workshop CONFIGURE_DEPENDS
    ${PROJECT_SOURCE_DIR}/apps/burr/window/*.cpp ${PROJECT_SOURCE_DIR}/apps/burr/workshop/*.cpp)
  list(APPEND BURR_APP_PARTS ${window_and_workshop})
  list(REMOVE_ITEM BURR_APP ${BURR_APP_PARTS})
  add_library(burr_app STATIC EXCLUDE_FROM_ALL ${BURR_APP_PARTS})
  burr_of_program(burr_app)

  add_executable(burr_program ${BURR_APP})
  set_target_properties(burr_program PROPERTIES OUTPUT_NAME burr RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
  burr_of_program(burr_program)
  target_link_libraries(burr_program PRIVATE burr_app)
  if(NOT BURR_WARNINGS_ONLY)  # holds the yardstick of `burr bench tick`, which is compiled as the library is
    set_source_files_properties(${PROJECT_SOURCE_DIR}/apps/burr/bench/bench_tick.cpp PROPERTIES
      COMPILE_OPTIONS "$<$<CONFIG:Release>:-O3>" SKIP_PRECOMPILE_HEADERS ON)
  endif()
endif()

# The bones of the built-in cases, shaped once here: their formulas take seconds (src/burr/workshop/prebuilt_phantom.h).
# Not where a sanitizer watches: there it takes minutes, and the program falls back on the formula.
if(BURR_APP AND NOT BURR_SANITIZE AND NOT BURR_WARNINGS_ONLY)
  foreach(phantom temporal-bone jaw tooth spine)
    set(bone ${CMAKE_BINARY_DIR}/bones/${phantom}.bone)
    add_custom_command(OUTPUT ${bone}
      COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/bones
      COMMAND burr_program phantom ${phantom} --out ${bone} > ${CMAKE_BINARY_DIR}/bones/${phantom}.txt 2>&1
      DEPENDS ${BURR_PHANTOMS} COMMENT "Shaping ${phantom}" VERBATIM)
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
