# Every check of ./test besides the unit tests, as tests of ctest. Label `long`: left out by ./test
# --quick; label `full-N`: left out by ./test (cmake/tiers.cmake). A test that builds uses all processors; one other test may run beside it, which takes what is left while the
# build waits for its last file.
find_package(Python3 COMPONENTS Interpreter)
include(ProcessorCount)
ProcessorCount(BURR_PROCESSORS)
set(checks ${PROJECT_SOURCE_DIR}/scripts/checks)

# ---- source code and documents
if(Python3_FOUND)
  add_test(NAME house.rooms COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/rooms.py)
  add_test(NAME house.rooms_are_watched COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/house/rooms_test.py)
  add_test(NAME house.long_functions COMMAND ${Python3_EXECUTABLE} ${checks}/long_functions.py)
  add_test(NAME house.long_functions_are_found COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/house/long_functions_test.py)
  add_test(NAME house.long_files COMMAND ${Python3_EXECUTABLE} ${checks}/long_files.py)
  add_test(NAME house.long_files_are_found COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/house/long_files_test.py)
  add_test(NAME house.header_names COMMAND ${Python3_EXECUTABLE} ${checks}/header_names.py)
  add_test(NAME house.header_names_are_found COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/house/header_names_test.py)
  add_test(NAME house.includes COMMAND ${Python3_EXECUTABLE} ${checks}/includes.py)
  add_test(NAME house.includes_are_found COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/house/includes_test.py)
  add_test(NAME house.sentences COMMAND ${Python3_EXECUTABLE} ${checks}/sentences.py)
  add_test(NAME house.sentences_are_watched COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/house/sentences_test.py)
  add_test(NAME house.gate_share COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/house/gate_share_test.py)
  add_test(NAME house.together COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/house/together_test.py)
  add_test(NAME house.same_bits COMMAND ${Python3_EXECUTABLE} ${checks}/same_bits.py $<TARGET_FILE:same_bits>)
  set_tests_properties(house.same_bits PROPERTIES TIMEOUT 600)
  add_test(NAME house.how_to_force_law COMMAND ${Python3_EXECUTABLE} ${checks}/how_to_force_law.py ${CMAKE_BINARY_DIR})
  set_tests_properties(house.how_to_force_law PROPERTIES TIMEOUT 300)
  add_test(NAME house.vices COMMAND ${Python3_EXECUTABLE} ${checks}/vices.py)
  add_test(NAME house.terms COMMAND ${Python3_EXECUTABLE} ${checks}/terms.py)
  add_test(NAME house.examples COMMAND ${Python3_EXECUTABLE} ${checks}/examples.py ${CMAKE_BINARY_DIR})
  add_test(NAME house.documents COMMAND ${Python3_EXECUTABLE} ${checks}/docs.py ${CMAKE_BINARY_DIR})
  add_test(NAME house.documents_are_checked COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/house/docs_test.py)
endif()
if(Python3_FOUND)
  add_test(NAME house.measures COMMAND ${Python3_EXECUTABLE} ${checks}/measures.py ${CMAKE_BINARY_DIR})
  set_tests_properties(house.measures PROPERTIES TIMEOUT 600)
endif()
if(NOT BURR_SANITIZE)
  add_test(NAME house.core_is_light COMMAND ${checks}/core_is_light.sh ${CMAKE_BINARY_DIR})
endif()
add_test(NAME house.format COMMAND ${checks}/format.sh)
set_tests_properties(house.format PROPERTIES SKIP_RETURN_CODE 77)
add_test(NAME house.words COMMAND ${checks}/words.sh)
add_test(NAME house.tidy COMMAND ${checks}/tidy.py ${CMAKE_BINARY_DIR})
add_test(NAME house.run COMMAND ${checks}/run.sh ${CMAKE_BINARY_DIR})
set_tests_properties(house.run PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 600)
add_test(NAME house.refuses COMMAND ${checks}/refuses.sh ${CMAKE_BINARY_DIR})
add_test(NAME house.no_pipes COMMAND ${checks}/no_pipes.sh ${CMAKE_BINARY_DIR}/burr)
add_test(NAME house.keeps_files COMMAND ${checks}/keeps_files.sh ${CMAKE_BINARY_DIR})
add_test(NAME house.finds_scans COMMAND ${checks}/finds_scans.sh ${CMAKE_BINARY_DIR})
if(Python3_FOUND)
  add_test(NAME house.psychophysics COMMAND ${checks}/psychophysics.sh ${CMAKE_BINARY_DIR})
  set_tests_properties(house.psychophysics PROPERTIES TIMEOUT 300)
  if(NOT BURR_SANITIZE AND TARGET burr_program)
    # statements for a learning record store, cmi5, and attacks on the instructor's page
    add_test(NAME school_xapi COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/school/xapi_test.py $<TARGET_FILE:burr_program>)
    add_test(NAME school_forget COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/school/forget_test.py $<TARGET_FILE:burr_program>)
    add_test(NAME serve_attacked COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/school/attack_serve.py $<TARGET_FILE:burr_program> --seconds 30)
    set_tests_properties(school_xapi school_forget serve_attacked PROPERTIES TIMEOUT 900 LABELS long)
    # DICOM segmentations, read by programs of others
    add_test(NAME io_segments_elsewhere COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/io/segments_elsewhere.py $<TARGET_FILE:burr_program>)
    # contours that pydicom writes, and an even-odd rule in numpy
    add_test(NAME io_contours_elsewhere COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/io/contours_elsewhere.py $<TARGET_FILE:burr_program>)
    set_tests_properties(io_segments_elsewhere io_contours_elsewhere PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300)
    # what people had trouble with, by the command line
    add_test(NAME importing_reported COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/importing/reported_test.py
      $<TARGET_FILE:burr_program> ${CMAKE_C_COMPILER})
    set_tests_properties(importing_reported PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300)
    # thousands of sessions: shards, kills, engines; and a cluster of Slurm on this computer
    add_test(NAME batch COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/batch/batch_test.py $<TARGET_FILE:burr_program>)
    add_test(NAME batch_slurm COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/batch/slurm_test.py $<TARGET_FILE:burr_program>)
    set_tests_properties(batch PROPERTIES TIMEOUT 900)
    set_tests_properties(batch_slurm PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300 LABELS long)
    # each call of a recording fails in turn; the signals that ask to end
    add_test(NAME record.failing_disk COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/record/failing_disk_test.py
      $<TARGET_FILE:burr_program> ${CMAKE_C_COMPILER})
    set_tests_properties(record.failing_disk PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 900)
    # the mouse in a real X server
    add_test(NAME window.pointer COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/window/pointer_test.py $<TARGET_FILE:burr_program>)
    set_tests_properties(window.pointer PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 900)
    add_test(NAME surgeon.tells_apart COMMAND ${Python3_EXECUTABLE} ${checks}/surgeons.py $<TARGET_FILE:burr_program>
      ${CMAKE_BINARY_DIR}/surgeons)
    set_tests_properties(surgeon.tells_apart PROPERTIES TIMEOUT 900)
  endif()
endif()
if(Python3_FOUND)
  add_test(NAME house.report COMMAND ${checks}/report.sh ${CMAKE_BINARY_DIR})
  set_tests_properties(house.report PROPERTIES TIMEOUT 300)
endif()
if(Python3_FOUND)
  add_test(NAME house.school COMMAND ${checks}/school.sh ${CMAKE_BINARY_DIR})
  set_tests_properties(house.school PROPERTIES TIMEOUT 300)
endif()
add_test(NAME house.web COMMAND ${checks}/web.sh ${CMAKE_BINARY_DIR})
set_tests_properties(house.web PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300)
add_test(NAME house.recording_trouble COMMAND ${checks}/recording_trouble.sh ${CMAKE_BINARY_DIR})
set_tests_properties(house.recording_trouble PROPERTIES TIMEOUT 300)
add_test(NAME house.install COMMAND ${checks}/install.sh ${CMAKE_BINARY_DIR})
set_tests_properties(house.tidy PROPERTIES PROCESSORS ${BURR_PROCESSORS} TIMEOUT 1200 LABELS long)
set_tests_properties(house.install PROPERTIES LABELS long RESOURCE_LOCK files_of_package)
if(TARGET burr_program AND NOT BURR_SANITIZE)
  add_test(NAME house.completion COMMAND ${checks}/completion.sh ${CMAKE_BINARY_DIR})
  add_test(NAME house.package COMMAND ${checks}/package.sh ${CMAKE_BINARY_DIR})
  set_tests_properties(house.package PROPERTIES TIMEOUT 600 LABELS long RESOURCE_LOCK files_of_package)
endif()

# ---- Each header compiles alone, with the warnings of the library. A header whose own .cpp
# includes it first has been tested by that (its headers of the C++ library by house.includes); the
# others are compiled here.
foreach(header ${BURR_HEADERS})
  string(REGEX REPLACE "\\.h$" ".cpp" own ${header})
  file(RELATIVE_PATH inside ${PROJECT_SOURCE_DIR}/src ${header})
  set(first "")
  if(EXISTS ${own})
    file(STRINGS ${own} first REGEX "^ *# *(include|if|define)" LIMIT_COUNT 1)
  endif()
  file(STRINGS ${header} guard REGEX "^#pragma once$" LIMIT_COUNT 1)
  if(guard AND first STREQUAL "#include \"${inside}\"")
    continue()
  endif()
  string(REPLACE "/" "_" name ${inside})
  set(unit ${CMAKE_BINARY_DIR}/headers/${name}.cpp)
  file(CONFIGURE OUTPUT ${unit} CONTENT "#include \"${inside}\"\n#include \"${inside}\"  // twice: guarded\n")
  list(APPEND header_units ${unit})
endforeach()
add_library(headers_alone OBJECT EXCLUDE_FROM_ALL ${header_units})
target_link_libraries(headers_alone PRIVATE burr burr_options)
target_include_directories(headers_alone PRIVATE ${PROJECT_SOURCE_DIR}/third_party)  # scenario/toml_reader.h
set_source_files_properties(${header_units} PROPERTIES COMPILE_OPTIONS -fsyntax-only)  # no code is written
target_compile_options(headers_alone PRIVATE -O0)
burr_common_headers(headers_alone)  # house.includes looks for missing headers of the C++ library
add_test(NAME house.headers_compile_alone
  COMMAND ${CMAKE_COMMAND} --build ${CMAKE_BINARY_DIR} --target headers_alone)
set_tests_properties(house.headers_compile_alone PROPERTIES PROCESSORS ${BURR_PROCESSORS} TIMEOUT 1200 LABELS long)

# ---- samples: one idea each; each checks itself
foreach(sample ${BURR_SAMPLES})
  get_filename_component(name ${sample} NAME_WE)
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/samples)
  add_test(NAME samples.${name} COMMAND ${name} WORKING_DIRECTORY ${CMAKE_BINARY_DIR}/samples)
  set_tests_properties(samples.${name} PROPERTIES TIMEOUT 300)
endforeach()
set_tests_properties(samples.s05_record_a_session PROPERTIES FIXTURES_SETUP a_recording)  # which these read
set_tests_properties(samples.s06_read_a_recording samples.s07_score_a_recording PROPERTIES FIXTURES_REQUIRED a_recording)
add_test(NAME samples.own_case COMMAND burr --quiet case check ${PROJECT_SOURCE_DIR}/samples/cases/plate_holes.toml)
add_test(NAME samples.own_rubric COMMAND burr --quiet rubric check ${PROJECT_SOURCE_DIR}/samples/cases/plate_holes_rubric.toml)

# ---- Other builds; only from the release build, which is the one that ./test makes.
if(NOT BURR_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_BUILD_TYPE STREQUAL "Release")
  # burr_other_build(PRESET TARGET...): configures and builds a preset, as a test on which others
  # may depend
  function(burr_other_build preset)
    add_test(NAME ${preset}.configure COMMAND ${CMAKE_COMMAND} --preset ${preset} ${${preset}_options}
      WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    add_test(NAME ${preset}.build COMMAND ${CMAKE_COMMAND} --build ${PROJECT_SOURCE_DIR}/build/${preset} --target ${ARGN})
    set_tests_properties(${preset}.configure PROPERTIES FIXTURES_SETUP ${preset}_tree LABELS long)
    set_tests_properties(${preset}.build PROPERTIES FIXTURES_REQUIRED ${preset}_tree FIXTURES_SETUP ${preset}_programs
      PROCESSORS ${BURR_PROCESSORS} TIMEOUT 3000 LABELS long)
  endfunction()
  # burr_other_test(PRESET ROOM FILTER): runs the room's tests in that build; FILTER as for gtest
  function(burr_other_test preset room filter)
    set(by)
    if(preset STREQUAL tsan)
      set(by ${checks}/tsan.sh)
    endif()
    add_test(NAME ${preset}.${room} COMMAND ${by} ${PROJECT_SOURCE_DIR}/build/${preset}/test_${room}
      --gtest_brief=1 --gtest_filter=${filter})
    set_tests_properties(${preset}.${room} PROPERTIES FIXTURES_REQUIRED ${preset}_programs TIMEOUT 1800 LABELS long
      ENVIRONMENT "UBSAN_OPTIONS=print_stacktrace=1;TSAN_OPTIONS=halt_on_error=1 second_deadlock_stack=1;ASAN_OPTIONS=detect_stack_use_after_return=1")
  endfunction()

  # burr_same_bits(PRESET NAME...): that build prints the same numbers as this one, for these of its
  # lines
  function(burr_same_bits preset)
    if(Python3_FOUND)
      list(TRANSFORM ARGN PREPEND --only= OUTPUT_VARIABLE lines)
      add_test(NAME ${preset}.same_bits COMMAND ${Python3_EXECUTABLE} ${checks}/same_bits.py $<TARGET_FILE:same_bits>
        --against ${PROJECT_SOURCE_DIR}/build/${preset}/same_bits ${lines})
      set_tests_properties(${preset}.same_bits PROPERTIES FIXTURES_REQUIRED ${preset}_programs TIMEOUT 900 LABELS long)
    endif()
  endfunction()

  # The second compiler, warnings as errors: the part of the library whose bits are compared, optimised
  # as for users, and the files that are only in the program. clang++ compiles all others for `asan`
  # and `tsan`, with the same warnings.
  burr_other_build(clang same_bits warnings_of_program)
  burr_same_bits(clang)

  # AddressSanitizer and UndefinedBehaviorSanitizer: code that reads files, and code that moves
  # memory. clang++ compiles it in a third of g++'s time, and the fuzzers below use the same
  # library. Sanitized code is several times slower, so the longest random tests run in the release
  # build only. The rooms that compute, those whose libraries are large (Boost.Beast, databases), and the
  # fuzzers are for the full tier.
  set(asan_rooms base volume edit surface io importing record)
  set(asan_more_rooms rt math tool haptics tick device school net)
  set(asan_filter_haptics "-*Million*:*Random*")
  set(asan_filter_importing "-ScanLaw.WhatIsKeptIsWhatTheMeshHas:ScanLaw.HoldsForRealScans")  # long, and shorter tests take the same way
  set(asan_filter_io "-Corpus.*")  # needs the program, which is not built here; CorpusAgainst reads
                                   # the same files
  # bounds of forces, which the release build tests; and an arm on DDS, whose opening takes 36 ms
  set(asan_filter_device "-*OfManyRandomForces*:LeaderTest.OpenedAndClosedManyTimes*")
  set(asan_filter_school "-*Server*")  # the release build talks to the server; libpq keeps memory to the end
  set(asan_filter_record "-Player.OpensAnyMomentOfTenMinutesAtOnce")  # long, and shorter tests take the same way
  list(TRANSFORM asan_rooms PREPEND test_ OUTPUT_VARIABLE asan_targets)
  list(TRANSFORM asan_more_rooms PREPEND test_ OUTPUT_VARIABLE asan_more_targets)
  burr_other_build(asan ${asan_targets} same_bits)
  burr_same_bits(asan pocket plunge scan)
  # in the same folder, after the others
  add_test(NAME asan.more_build COMMAND ${CMAKE_COMMAND} --build ${PROJECT_SOURCE_DIR}/build/asan --target ${asan_more_targets} fuzzers)
  set_tests_properties(asan.more_build PROPERTIES FIXTURES_REQUIRED asan_programs FIXTURES_SETUP asan_more_programs
    PROCESSORS ${BURR_PROCESSORS} TIMEOUT 3000 LABELS long)
  foreach(room ${asan_rooms} ${asan_more_rooms})
    set(filter "*")
    if(DEFINED asan_filter_${room})
      set(filter "${asan_filter_${room}}")
    endif()
    burr_other_test(asan ${room} "${filter}")
  endforeach()
  foreach(room ${asan_more_rooms})
    set_property(TEST asan.${room} APPEND PROPERTY FIXTURES_REQUIRED asan_more_programs)
  endforeach()

  set(tsan_options -DBURR_READER=OFF)
  # ThreadSanitizer: the doors; bone, mesh and recording while other threads read; a whole session;
  # the whole program, for minutes with scripts/tsan_long.sh
  # The reader of scans is a process of its own with one thread, so the one of the release build will do.
  burr_other_build(tsan test_rt test_volume test_surface test_sound test_record test_sim test_device test_window)
  burr_other_test(tsan rt "*")
  burr_other_test(tsan volume "Bone.*:SharedCopy.*")
  burr_other_test(tsan surface "Worker.Shows*:Worker.Keeps*:Mesher.Workers*")
  burr_other_test(tsan sound "*")
  burr_other_test(tsan record "*Recorder*")
  burr_other_test(tsan sim "WholeSession.*")
  burr_other_test(tsan device "*-*Million*:*Thousand*:*OpenedAndClosedManyTimes*:*Hundred*Times*")
  # The program's threads. A press that lasts long loses ticks in this build, and then the hand does
  # not get its force back; WholeProgram tests undo as well.
  burr_other_test(tsan window "WholeProgram.*:Window.*-Window.UndoByKey*")
  set(tsan_runs "TSAN_OPTIONS=halt_on_error=1 second_deadlock_stack=1 suppressions=${PROJECT_SOURCE_DIR}/scripts/checks/tsan_suppressions.txt")
  set_property(TEST tsan.window PROPERTY ENVIRONMENT ${tsan_runs} BURR_WINDOW_SECONDS=15)
  set_property(TEST tsan.device PROPERTY ENVIRONMENT ${tsan_runs})
  set_property(TEST tsan.window tsan.device tsan.record tsan.sim APPEND PROPERTY ENVIRONMENT BURR_READ=$<TARGET_FILE:burr_read>)
  # in real time, and mostly waiting: may run beside other tests, but not beside each other
  set_tests_properties(asan.device tsan.device PROPERTIES RESOURCE_LOCK clock)
  set_tests_properties(tsan.window PROPERTIES RESOURCE_LOCK clock PROCESSORS ${BURR_PROCESSORS})

  # other processors and systems: the core alone, and the same bits as here
  foreach(processor aarch64 windows web)
    add_test(NAME portable.${processor} COMMAND ${checks}/portable.sh ${processor} ${CMAKE_BINARY_DIR})
    set_tests_properties(portable.${processor} PROPERTIES SKIP_RETURN_CODE 77 PROCESSORS ${BURR_PROCESSORS} TIMEOUT 1800 LABELS long
      FIXTURES_SETUP portable_${processor})
  endforeach()
  # the unit tests of the core, three minutes on one processor: beside other tests
  add_test(NAME portable.aarch64_tests COMMAND ${checks}/portable.sh aarch64 ${CMAKE_BINARY_DIR} tests)
  set_tests_properties(portable.aarch64_tests PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 1800 LABELS long FIXTURES_REQUIRED portable_aarch64)

  # the page that portable.web has built, in a browser
  add_test(NAME page COMMAND ${checks}/page.sh ${CMAKE_BINARY_DIR})
  add_test(NAME page_more COMMAND ${checks}/page.sh ${CMAKE_BINARY_DIR} more)
  set_tests_properties(page PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 1800 LABELS long
    FIXTURES_REQUIRED portable_web)
  # a page whose picture a processor draws is slow beside other work, so what it shows comes late: nearly alone, and once more alone
  set_tests_properties(page_more PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 3600 PROCESSORS ${BURR_PROCESSORS} LABELS "long;again" FIXTURES_REQUIRED portable_web)

  # in another page's frame and as a course; the npm package; another browser
  foreach(part framed npm firefox)
    add_test(NAME page_${part} COMMAND ${checks}/page.sh ${CMAKE_BINARY_DIR} ${part})
    set_tests_properties(page_${part} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 1800 LABELS long FIXTURES_REQUIRED portable_web)
  endforeach()

  # how a page is published, kept and bound, with a small one: needs no build
  add_test(NAME page_published COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/web/tests/publish_test.py)
  set_tests_properties(page_published PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 900 LABELS long)

  # the instructor's page, in a browser; its replay draws with the page that portable.web has built
  add_test(NAME school_page COMMAND ${checks}/school_page.sh ${CMAKE_BINARY_DIR})
  set_tests_properties(school_page PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 1800 LABELS long FIXTURES_REQUIRED portable_web)
  set_tests_properties(page page_more page_framed page_npm page_firefox school_page PROPERTIES RESOURCE_LOCK browser)

  # libFuzzer: 3 s for every reader; scripts/fuzz_night.sh runs longer
  add_test(NAME fuzz.seeds COMMAND ${checks}/fuzz.sh seeds)
  set_tests_properties(fuzz.seeds PROPERTIES FIXTURES_REQUIRED asan_more_programs FIXTURES_SETUP fuzz_seeds LABELS long)
  file(GLOB fuzz_targets CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/fuzz ${PROJECT_SOURCE_DIR}/fuzz/*_fuzz.cpp)
  foreach(file ${fuzz_targets})
    string(REGEX REPLACE "_fuzz\\.cpp$" "" name ${file})
    add_test(NAME fuzz.${name} COMMAND ${checks}/fuzz.sh ${name} 3)
    set_tests_properties(fuzz.${name} PROPERTIES FIXTURES_REQUIRED "asan_more_programs;fuzz_seeds" TIMEOUT 300 LABELS long)
  endforeach()
endif()

# The other builds come first. Each takes all processors, so it would wait until the last of the other tests has begun, and
# at the end tests in real time, which run one after the other, would leave a core idle. Without these builds (./test --quick)
# this is left out, and the tests begin at once.
add_test(NAME other_builds COMMAND ${CMAKE_COMMAND} -E true)
set_tests_properties(other_builds PROPERTIES LABELS long)
foreach(build asan.build asan.more_build tsan.build clang.build portable.aarch64 portable.windows portable.web)
  if(TEST ${build})
    set_property(TEST other_builds APPEND PROPERTY DEPENDS ${build})
  endif()
endforeach()

# all known bones, at two voxel sizes and on other bones: of the full tier
add_test(NAME house.verify_scores COMMAND burr_program --quiet verify scores)
set_tests_properties(house.verify_scores PROPERTIES TIMEOUT 3600)

include(cmake/tiers.cmake)

# every claim about touch, within a minute; real bones where they are available
set(verify_data "")
if(EXISTS ${PROJECT_SOURCE_DIR}/../shared/data)
  set(verify_data --data ${PROJECT_SOURCE_DIR}/../shared/data)
endif()
add_test(NAME house.verify COMMAND burr_program --quiet verify --quick ${verify_data})
set_tests_properties(house.verify PROPERTIES TIMEOUT 900)

# The longest tests start first, so that no core waits at the end for the other. Rough seconds.
set(costs house.same_bits 50 house.measures 30 house.recording_trouble 25 house.run 20 house.install 20 house.verify 40
  haptics.Proxy.AMillionTicksAtUpToTenMillimetresNeverCrossAThinPlate 70 io.Corpus.EveryFileIsReadOrRefusedWithASentence 40
  io.CorpusAgainst.ASecondReaderSeesTheSame 30
  asan.device 110 asan.io 160 tsan.device 130 tsan.window 120 asan.haptics 60 asan.volume 40 asan.edit 40 asan.record 90 asan.same_bits 40 asan.importing 40 tsan.sim 60 tsan.rt 40
  clang.same_bits 30 portable.aarch64_tests 90
  window.ImportWindow.SaysWhatIsWrongWithANumberAndLosesNothing 20)
set(orders "")
while(costs)
  list(POP_FRONT costs test seconds)
  string(APPEND orders "set_tests_properties(${test} PROPERTIES COST ${seconds})\n")
endwhile()
# the loss by a kill is judged in milliseconds of a clock, so no other test may disturb it
string(APPEND orders "set_tests_properties(sim.Killed.AtAnyMomentItOpensLacksATenthOfASecondAtMostAndReplaysToTheBit "
  "PROPERTIES RUN_SERIAL TRUE)\n")
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/costs.cmake CONTENT "${orders}")
# read last, after ctest has asked the test programs for their tests
set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_BINARY_DIR}/costs.cmake)
