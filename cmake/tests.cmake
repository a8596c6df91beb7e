# tests/<room>/x_test.cpp -> one test program per room
find_package(GTest REQUIRED)
include(GoogleTest)

file(GLOB BURR_TEST_SUPPORT CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/support/*.cpp)
list(FILTER BURR_TEST_SUPPORT EXCLUDE REGEX "_windows\\.cpp$")
add_library(burr_test_support STATIC ${BURR_TEST_SUPPORT})
set_source_files_properties(${PROJECT_SOURCE_DIR}/tests/support/rt_guard.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)  # it defines malloc
# it alone knows where this checkout lies, so a compiler's cache finds all other sources again in another folder
set_source_files_properties(${PROJECT_SOURCE_DIR}/tests/support/test_places.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON
  COMPILE_DEFINITIONS "BURR_SOURCE_DIR=\"${PROJECT_SOURCE_DIR}\";BURR_BUILD_DIR=\"${CMAKE_BINARY_DIR}\"")
target_include_directories(burr_test_support PUBLIC ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests)
target_link_libraries(burr_test_support PUBLIC burr burr_scenes GTest::gtest fmt::fmt ${CMAKE_DL_LIBS} PRIVATE burr_options)

# two fake servers with all of Boost.Beast, compiled once
add_library(fake_haply STATIC EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/tests/device/fake/fake_haply.cpp ${PROJECT_SOURCE_DIR}/tests/device/fake/fake_haply_35.cpp)
target_include_directories(fake_haply PRIVATE ${PROJECT_SOURCE_DIR}/tests)
target_link_libraries(fake_haply PUBLIC burr PRIVATE burr_options nlohmann_json::nlohmann_json)
burr_glue(fake_haply)

file(GLOB rooms CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/tests ${PROJECT_SOURCE_DIR}/tests/*)
# ThreadSanitizer tests only what has threads (cmake/checks.cmake), AddressSanitizer not pure
# arithmetic
set(with_threads "tests/(rt|device)/|(window/window|window/pages|sound/voice|sound/speaker|volume/bone|surface/mesher|surface/worker|record/recorder|sim/threads)_test.cpp$")
# Late ticks release the force of a hand at the window, so no two such tests run beside each other. Other tests do: all 158
# passed with two compilers beside them on two cores. They begin early (COST), so that at the end no core waits for them.
# The groups of the room `window` named here open no session in real time: they passed three times in a row on two cores
# with a load of 16. ImportWindow begins sessions, but looks only at what they began with; two copies of it at once passed
# with the same load. Replay plays recordings: three copies of each of its tests at once passed on two cores with a load of
# 12 to 20. Not so ReplayByMouse, where two tests waited for 120 s in vain, and FilmFiles, where a film had not begun after 2 s.
# Tests of devices in real time mostly wait, and use a fifth of a core: they run beside tests of other rooms, but not
# beside each other. On two cores with a load of 9 all of them passed, slowed down by a sanitizer. They run one after the
# other beside the other builds, and for that alone do not wait for them (`at_once`, COST).
set(alone_but_window Cap Grip Tools/Rack RackOfASession Directions ExportPieces ExportRequest Film Greys HandPlane Hands ImguiKeys ImportDoubts ImportWindow LabelTable Measuring Memory DocumentsFolder MillCases MillNotes MirrorWords Planes Steps Technique
  Bones/Hover HoverHand TypedPath PrebuiltPhantom Preview PrintedKeys Questions RateWindow Region Replay Scores StatusLine Words Work SavedViewsFile SettingsFile)
set(manner_window RESOURCE_LOCK window COST 40)
set(manner_device RESOURCE_LOCK clock COST 500)
set(at_once device)
set(alone_but_device OmegaTest MappedHand HaplyMessage CrtkNames CrtkReading PolhemLine PolhemPorts ListingTest TouchTest
  InverseTest.OfMany* PolhemTest.OfMany* InverseTest.OpenedAndClosedMany* PolhemTest.OpenedAndClosedMany* LeaderTest.OpenedAndClosedMany*)
foreach(room ${rooms})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/${room}/*_test.cpp)
  list(FILTER sources EXCLUDE REGEX "_windows_test\\.cpp$")  # cmake/portable.cmake
  if(BURR_SANITIZE STREQUAL "thread")
    list(FILTER sources INCLUDE REGEX "${with_threads}")
  elseif(BURR_SANITIZE MATCHES "address")
    list(FILTER sources EXCLUDE REGEX "haptics/(stability|energy_guard|vibration|limit)_test.cpp$")
    if(room STREQUAL tick)  # whole sessions are for the release build
      list(FILTER sources INCLUDE REGEX "tick/tick_hash_test.cpp$")
    endif()
  endif()
  if(sources)
    file(GLOB kernels CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/${room}/*_scalar.cpp
      ${PROJECT_SOURCE_DIR}/tests/${room}/*_avx2.cpp ${PROJECT_SOURCE_DIR}/tests/${room}/*_avx512.cpp)
    burr_kernels(${kernels})
    add_executable(test_${room} ${sources} ${kernels})
    target_link_libraries(test_${room} PRIVATE burr_test_support burr_options GTest::gtest_main nlohmann_json::nlohmann_json
      ZLIB::ZLIB PkgConfig::ZSTD PkgConfig::ASSIMP PkgConfig::EPOXY PkgConfig::SDL2)
    if(room MATCHES "^(window|sound|devices|doctor)$")  # of the program, not of the library
      target_include_directories(test_${room} PRIVATE ${PROJECT_SOURCE_DIR}/apps/burr ${PROJECT_SOURCE_DIR}/third_party)
      target_link_libraries(test_${room} PRIVATE burr_app CLI11::CLI11 PkgConfig::IMGUI)
    endif()
    if(room STREQUAL net)
      target_link_libraries(test_net PRIVATE burr_net)
    endif()
    if(room STREQUAL school)
      # a recording becomes a session: of the program, and needs nothing else of it
      target_sources(test_school PRIVATE ${PROJECT_SOURCE_DIR}/apps/burr/school/session_of.cpp)
      target_include_directories(test_school PRIVATE ${PROJECT_SOURCE_DIR}/apps/burr)
      target_link_libraries(test_school PRIVATE burr_school burr_lrs)
    endif()
    if(room STREQUAL dataset)
      target_link_libraries(test_dataset PRIVATE burr_dataset)
    endif()
    if(room MATCHES "^(proof|scoring)$")
      target_link_libraries(test_${room} PRIVATE burr_proof)
    endif()
    if(room STREQUAL device)
      target_link_libraries(test_device PRIVATE burr_crtk fake_haply)
    endif()
    set(manner calls)
    if(BURR_SANITIZE MATCHES "address" AND room MATCHES "^(edit|haptics|importing|io|record|surface|tool|volume)$")
      set(manner computes)  # these tests compute for themselves what they compare with: -O1, since without it those of `edit` take four times as long
    else()
      burr_glue(test_${room})
    endif()
    if(BURR_SANITIZE MATCHES "undefined")  # checks in the library only, not in its tests
      set_source_files_properties(${sources} PROPERTIES COMPILE_OPTIONS -fno-sanitize=undefined,float-cast-overflow)
    endif()
    if(first_that_${manner})  # the same options, so one set of headers for all
      burr_common_headers(test_${room} REUSE_FROM test_${first_that_${manner}})
    else()
      set(first_that_${manner} ${room})
      burr_common_headers(test_${room} <gtest/gtest.h>)
    endif()
    set(discovering TEST_PREFIX ${room}. DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 120 PROPERTIES TIMEOUT 900)
    set(after_builds DEPENDS other_builds)
    if(room STREQUAL web)  # those that need the built page: scripts/checks/page.sh
      gtest_discover_tests(test_web TEST_FILTER "-PageCodecs*" ${discovering} ${after_builds})
    elseif(alone_but_${room})  # twice: what runs beside others, and what runs alone
      list(TRANSFORM alone_but_${room} APPEND ".*" REGEX "^[^.]+$")  # a whole group
      list(JOIN alone_but_${room} ":" free)
      gtest_discover_tests(test_${room} TEST_FILTER "${free}" ${discovering} ${after_builds})
      if(room IN_LIST at_once)
        set(after_builds "")
      endif()
      gtest_discover_tests(test_${room} TEST_FILTER "-${free}" ${discovering} ${manner_${room}} ${after_builds})
    else()
      gtest_discover_tests(test_${room} ${discovering} ${after_builds})
    endif()
  endif()
endforeach()

# prints its numbers in every kind of build; scripts/checks/same_bits.py compares them
add_executable(same_bits ${PROJECT_SOURCE_DIR}/tests/bits/same_bits.cpp)
if(BURR_WARNINGS_ONLY)  # of the library only what the numbers depend on
  target_sources(same_bits PRIVATE ${BURR_SCENES})
  target_include_directories(same_bits PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(same_bits PRIVATE burr_core burr_files burr_session burr_options fmt::fmt)
else()
  target_link_libraries(same_bits PRIVATE burr burr_scenes burr_options fmt::fmt)
endif()
target_include_directories(same_bits PRIVATE ${PROJECT_SOURCE_DIR}/tests)  # support/folder.h

# the same for burr_core alone, on other processors too (cmake/portable.cmake, scripts/checks/portable.sh)
add_executable(portable_bits ${PROJECT_SOURCE_DIR}/tests/bits/portable_bits.cpp)
target_link_libraries(portable_bits PRIVATE burr_core burr_options)

# a reader that misbehaves behind the same fence as burr-read (tests/io/fence_test.cpp)
add_executable(naughty_reader ${PROJECT_SOURCE_DIR}/tests/io/naughty/naughty_reader.cpp)
set_target_properties(naughty_reader PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
target_link_libraries(naughty_reader PRIVATE burr_readers burr_options)
if(TARGET test_io)
  target_link_libraries(test_io PRIVATE burr_readers)  # the readers of burr-read, without the fence
  add_dependencies(test_io naughty_reader)
endif()

# an OpenXR loader and runtime that the test plays (tests/render/openxr/fake_openxr.h)
add_library(fake_openxr MODULE ${PROJECT_SOURCE_DIR}/tests/render/openxr/fake_openxr.cpp)
set_target_properties(fake_openxr PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
target_link_libraries(fake_openxr PRIVATE burr_options PkgConfig::EPOXY PkgConfig::SDL2)
foreach(room render window)
  if(TARGET test_${room})
    add_dependencies(test_${room} fake_openxr)
  endif()
endforeach()
# custom laws, compiled as a user would: the sample, and those that misbehave. C, but by the compiler that is there
function(burr_law name source)
  add_library(law_${name} MODULE ${PROJECT_SOURCE_DIR}/${source})
  set_source_files_properties(${PROJECT_SOURCE_DIR}/${source} PROPERTIES LANGUAGE CXX)
  target_include_directories(law_${name} PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_compile_definitions(law_${name} PRIVATE ${ARGN})
  set_target_properties(law_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name} LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/laws)
  if(TARGET test_workshop)
    add_dependencies(test_workshop law_${name})
  endif()
endfunction()
burr_law(hardening samples/laws/hardening.c)
foreach(kind twice pays nan crashes hangs shares pushes is_none)
  string(TOUPPER LAW_${kind} macro)
  burr_law(${kind} tests/support/laws/law.c ${macro})
endforeach()

# a libspnav without a daemon, loaded like the real one (tests/window/hands_test.cpp)
add_library(fake_spnav SHARED ${PROJECT_SOURCE_DIR}/tests/window/fake/fake_spnav.cpp)
target_link_libraries(fake_spnav PRIVATE burr_options)
set_target_properties(fake_spnav PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
if(TARGET test_window)
  add_dependencies(test_window fake_spnav)
endif()
# makers' libraries without a device, loaded like the real ones (tests/device/fake/)
function(burr_fake_library target name source)
  add_library(${target} SHARED ${PROJECT_SOURCE_DIR}/tests/device/fake/${source})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests ${PROJECT_SOURCE_DIR}/src)
  target_compile_definitions(${target} PRIVATE ${ARGN})
  target_link_libraries(${target} PRIVATE Eigen3::Eigen burr_options)
  if(BURR_SANITIZE MATCHES "undefined")  # they have types of their own, as a maker's library has
    set_source_files_properties(${PROJECT_SOURCE_DIR}/tests/device/fake/${source} PROPERTIES
      COMPILE_OPTIONS -fno-sanitize=function)
  endif()
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${name} LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/fakes)
  foreach(room device window doctor)
    if(TARGET test_${room})
      add_dependencies(test_${room} ${target})
    endif()
  endforeach()
endfunction()
burr_fake_library(fake_hd HD fake_hd.cpp)
burr_fake_library(fake_hd_old HD_old fake_hd.cpp FAKE_HD_OLD)
burr_fake_library(fake_hd_crash HD_crash fake_trouble.cpp FAKE_CRASHES)
burr_fake_library(fake_hd_hang HD_hang fake_trouble.cpp FAKE_HANGS)
burr_fake_library(fake_drd drd fake_dhd.cpp)
burr_fake_library(fake_drd_old drd_old fake_dhd.cpp FAKE_DHD_OLD)
burr_fake_library(fake_drd_broken drd_broken fake_dhd.cpp FAKE_DHD_BROKEN)
burr_fake_library(fake_dhd dhd fake_dhd.cpp FAKE_DHD_ALONE)
if(TARGET test_device AND TARGET burr_program)
  add_dependencies(test_device burr_guard)
endif()
if(TARGET test_web)
  target_sources(test_web PRIVATE ${PROJECT_SOURCE_DIR}/web/import/rle.cpp ${PROJECT_SOURCE_DIR}/web/import/jpeg_lossless.cpp)
  target_link_libraries(test_web PRIVATE burr_gdcm)
endif()
if(TARGET test_golden)
  add_dependencies(test_golden burr)
endif()
if(EXISTS ${PROJECT_SOURCE_DIR}/cmake/checks.cmake)
  include(cmake/checks.cmake)
endif()

# a fake device for measurements, or to try burr without hardware (bench/results/device.md)
add_executable(false_device EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/bench/device/false_device.cpp)
target_include_directories(false_device PRIVATE ${PROJECT_SOURCE_DIR}/tests)
target_link_libraries(false_device PRIVATE burr burr_crtk fake_haply burr_options fmt::fmt)

# bench/<room>/x_bench.cpp -> one Google Benchmark program each; no test depends on them
find_package(benchmark QUIET)
if(benchmark_FOUND)
  file(GLOB_RECURSE benches CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bench/*_bench.cpp)
  foreach(bench ${benches})
    get_filename_component(name ${bench} NAME_WE)
    add_executable(${name} EXCLUDE_FROM_ALL ${bench})
    target_link_libraries(${name} PRIVATE burr burr_scenes burr_options benchmark::benchmark fmt::fmt)
  endforeach()
endif()
