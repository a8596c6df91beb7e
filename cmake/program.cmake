# the program `burr`: one file per subcommand
file(GLOB_RECURSE BURR_APP CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/apps/burr/*.cpp)
if(BURR_APP)
  # The instructor's page becomes part of the program.
  set(BURR_PAGE_FILES "")
  foreach(file index.html school.css school.mjs live.mjs rating.mjs replay.mjs words.mjs rating_words.mjs)
    set(path ${PROJECT_SOURCE_DIR}/web/school/${file})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${path})
    get_filename_component(ending ${file} LAST_EXT)
    string(REGEX REPLACE "^[.]" "" ending ${ending})
    string(REPLACE "mjs" "javascript" type ${ending})
    file(READ ${path} text)
    string(APPEND BURR_PAGE_FILES "    {\"/${file}\", \"text/${type}; charset=utf-8\", R\"page(${text})page\"},\n")
  endforeach()
  configure_file(${PROJECT_SOURCE_DIR}/cmake/page_files.cpp.in ${CMAKE_BINARY_DIR}/page_files.cpp @ONLY)

  # Times that were measured beside other programs become a table of `burr verify`, which measures no times.
  set(path ${PROJECT_SOURCE_DIR}/bench/results/one_sphere.csv)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${path})
  file(READ ${path} BURR_ONE_SPHERE)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/one_sphere.cpp.in ${CMAKE_BINARY_DIR}/one_sphere.cpp @ONLY)

  # burr_of_program(TARGET [HEADER...]): what all that is compiled of it have in common; HEADER: parsed once for all
  function(burr_of_program target)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/apps/burr
      ${PROJECT_SOURCE_DIR}/third_party)
    target_link_libraries(${target} PRIVATE burr burr_school burr_lrs burr_net burr_dataset burr_proof burr_scenes burr_options CLI11::CLI11 fmt::fmt spdlog::spdlog
      nlohmann_json::nlohmann_json PkgConfig::EPOXY PkgConfig::SDL2 PkgConfig::IMGUI)
    target_compile_definitions(${target} PRIVATE BURR_VERSION="${PROJECT_VERSION}")
    burr_common_headers(${target} <fmt/format.h> <nlohmann/json.hpp> ${ARGN})
    burr_glue(${target})
  endfunction()

  # the parts that tests use as well, compiled once: the floors below the subcommands, the window, and of the trials what is named
  set(BURR_APP_PARTS commands/case_new commands/export_pieces commands/session_lines school/products serve/stations
    devices/trial devices/trial_words doctor/run_in_process doctor/devices_there doctor/finding doctor/fix doctor/nodes)
  list(TRANSFORM BURR_APP_PARTS REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/apps/burr/\\1.cpp")
  foreach(floor shared window)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/apps/burr/${floor}/*.cpp)
    list(APPEND BURR_APP_PARTS ${sources})
  endforeach()
  list(REMOVE_ITEM BURR_APP ${BURR_APP_PARTS})
  add_library(burr_app STATIC EXCLUDE_FROM_ALL ${BURR_APP_PARTS})
  burr_of_program(burr_app)

  add_executable(burr_program ${BURR_APP} ${CMAKE_BINARY_DIR}/page_files.cpp ${CMAKE_BINARY_DIR}/one_sphere.cpp)
  set_target_properties(burr_program PROPERTIES OUTPUT_NAME burr RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
  burr_of_program(burr_program <CLI/CLI.hpp>)
  target_link_libraries(burr_program PRIVATE burr_app)
  if(BURR_WARNINGS_ONLY)  # the files that are in no sanitizer's build, which clang++ reads too; it writes no code for them
    set_source_files_properties(${BURR_APP} ${dataset_sources} ${proof_sources} PROPERTIES COMPILE_OPTIONS -fsyntax-only)
    add_custom_target(warnings_of_program DEPENDS $<TARGET_OBJECTS:burr_program> $<TARGET_OBJECTS:burr_dataset> $<TARGET_OBJECTS:burr_proof>)
  endif()
  if(NOT BURR_WARNINGS_ONLY)  # it contains the reference code of `burr bench tick`, compiled like
                              # the library
    set_source_files_properties(${PROJECT_SOURCE_DIR}/apps/burr/bench/bench_tick.cpp PROPERTIES
      COMPILE_OPTIONS "$<$<CONFIG:Release>:-O3>" SKIP_PRECOMPILE_HEADERS ON)
  endif()
endif()

# The bones of the built-in cases, shaped once at build time: their formulas take seconds
# (src/burr/workshop/prebuilt_phantom.h). Not in sanitizer builds, where this takes minutes; there
# the program uses the formula.
if(BURR_APP AND NOT BURR_SANITIZE AND NOT BURR_WARNINGS_ONLY)
  foreach(phantom temporal-bone temporal-bone?ridge-dura jaw jaw?long,defect tooth tooth?graded spine)
    string(REGEX REPLACE "[?,]" "-" file ${phantom})
    set(bone ${CMAKE_BINARY_DIR}/bones/${file}.bone)
    add_custom_command(OUTPUT ${bone}
      COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/bones
      COMMAND burr_program phantom ${phantom} --out ${bone} > ${CMAKE_BINARY_DIR}/bones/${file}.txt 2>&1
      DEPENDS ${BURR_PHANTOMS} COMMENT "Shaping ${phantom}" VERBATIM)
    list(APPEND BURR_BONES ${bone})
  endforeach()
  add_custom_target(burr_bones ALL DEPENDS ${BURR_BONES})
endif()

file(GLOB BURR_SAMPLES CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/samples/s[0-9]*.cpp)
foreach(sample ${BURR_SAMPLES})
  get_filename_component(name ${sample} NAME_WE)
  add_executable(${name} ${sample})
  target_link_libraries(${name} PRIVATE burr burr_options)  # what an installation offers, samples/installed
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O0>)  # they only call the library
endforeach()
