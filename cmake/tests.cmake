# tests/<room>/x_test.cpp -> one test program per room
find_package(GTest REQUIRED)
include(GoogleTest)
pkg_check_modules(ASSIMP REQUIRED IMPORTED_TARGET assimp)  # reads back what we write

file(GLOB BURR_TEST_SUPPORT CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/support/*.cpp)
add_library(burr_test_support STATIC ${BURR_TEST_SUPPORT})
target_include_directories(burr_test_support PUBLIC ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/tests)
target_link_libraries(burr_test_support PUBLIC burr burr_scenes GTest::gtest fmt::fmt ${CMAKE_DL_LIBS} PRIVATE burr_options)

file(GLOB rooms CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/tests ${PROJECT_SOURCE_DIR}/tests/*)
# ThreadSanitizer is asked only about what has threads (cmake/checks.cmake), AddressSanitizer not about what is
# arithmetic only
set(with_threads "tests/(rt|window)/|(sound/voice|sound/speaker|volume/bone|surface/mesher|surface/worker|record/recorder|sim/threads)_test.cpp$")
foreach(room ${rooms})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/${room}/*_test.cpp)
  if(BURR_SANITIZE STREQUAL "thread")
    list(FILTER sources INCLUDE REGEX "${with_threads}")
  elseif(BURR_SANITIZE MATCHES "address")
    list(FILTER sources EXCLUDE REGEX "haptics/(stability|energy_guard|vibration|limit)_test.cpp$")
  endif()
  if(sources)
    add_executable(test_${room} ${sources})
    target_link_libraries(test_${room} PRIVATE burr_test_support burr_options GTest::gtest_main nlohmann_json::nlohmann_json
      ZLIB::ZLIB PkgConfig::ZSTD PkgConfig::ASSIMP PkgConfig::EPOXY PkgConfig::SDL2)
    if(room MATCHES "^(window|sound)$")  # of the program, not of the library
      set(parts hearing loudspeaker nearby)
      if(room STREQUAL window)
        list(APPEND parts live_bone traces work volume_options ready_bone recording still import_choice import_preview)
        target_link_libraries(test_${room} PRIVATE PkgConfig::IMGUI)
      endif()
      file(GLOB of_program CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/apps/burr/${room}/*.cpp)
      foreach(part ${parts})
        list(APPEND of_program ${PROJECT_SOURCE_DIR}/apps/burr/${part}.cpp)
      endforeach()
      target_sources(test_${room} PRIVATE ${of_program})
      target_include_directories(test_${room} PRIVATE ${PROJECT_SOURCE_DIR}/apps/burr ${PROJECT_SOURCE_DIR}/third_party)
      target_link_libraries(test_${room} PRIVATE CLI11::CLI11)
    endif()
    target_compile_definitions(test_${room} PRIVATE
      BURR_SOURCE_DIR="${PROJECT_SOURCE_DIR}" BURR_BUILD_DIR="${CMAKE_BINARY_DIR}")
    burr_glue(test_${room})
    if(BURR_SANITIZE MATCHES "undefined")  # asked of the library, not of its tests
      set_source_files_properties(${sources} PROPERTIES COMPILE_OPTIONS -fno-sanitize=undefined,float-cast-overflow)
    endif()
    if(first_room)  # the same options: one set of headers for all
      burr_common_headers(test_${room} REUSE_FROM test_${first_room})
    else()
      set(first_room ${room})
      burr_common_headers(test_${room} <gtest/gtest.h>)
    endif()
    # a hand at the window is let go when its ticks are late: nothing else may run beside it
    set(alone FALSE)
    if(room STREQUAL window)
      set(alone TRUE)
    endif()
    gtest_discover_tests(test_${room} TEST_PREFIX ${room}. DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 120
      PROPERTIES TIMEOUT 900 RUN_SERIAL ${alone})
  endif()
endforeach()

# says its numbers in every kind of build, scripts/checks/same_bits.py compares them
add_executable(same_bits ${PROJECT_SOURCE_DIR}/tests/bits/same_bits.cpp)
target_link_libraries(same_bits PRIVATE burr burr_scenes burr_options fmt::fmt)

# a reader that misbehaves behind the same fence as burr-read (tests/io/fence_test.cpp)
add_executable(naughty_reader ${PROJECT_SOURCE_DIR}/tests/io/naughty/naughty_reader.cpp)
set_target_properties(naughty_reader PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
target_link_libraries(naughty_reader PRIVATE burr_readers burr_options)
if(TARGET test_io)
  target_link_libraries(test_io PRIVATE burr_readers)  # what burr-read calls, without the fence
  add_dependencies(test_io naughty_reader)
endif()
# a libspnav without a daemon, loaded as the real one is (tests/window/hands_test.cpp)
add_library(fake_spnav SHARED ${PROJECT_SOURCE_DIR}/tests/window/fake/fake_spnav.cpp)
target_link_libraries(fake_spnav PRIVATE burr_options)
set_target_properties(fake_spnav PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
if(TARGET test_window)
  add_dependencies(test_window fake_spnav)
endif()
if(TARGET test_golden)
  add_dependencies(test_golden burr)
endif()
if(EXISTS ${PROJECT_SOURCE_DIR}/cmake/checks.cmake)
  include(cmake/checks.cmake)
endif()

# bench/<room>/x_bench.cpp -> one Google Benchmark program each; never part of pass or fail
find_package(benchmark QUIET)
if(benchmark_FOUND)
  file(GLOB_RECURSE benches CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bench/*_bench.cpp)
  foreach(bench ${benches})
    get_filename_component(name ${bench} NAME_WE)
    add_executable(${name} EXCLUDE_FROM_ALL ${bench})
    target_link_libraries(${name} PRIVATE burr burr_scenes burr_options benchmark::benchmark fmt::fmt)
  endforeach()
endif()
