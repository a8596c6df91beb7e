# `cmake --install` gives others a library: find_package(burr), targets burr::burr and burr::core
include(CMakePackageConfigHelpers)
install(TARGETS burr_core burr EXPORT burrTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(TARGETS burr_read burr_seg burr_guard RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/burr COMPONENT program)
if(TARGET burr_program)
  set_target_properties(burr_program PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS burr_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  install(FILES ${BURR_BONES} DESTINATION ${CMAKE_INSTALL_DATADIR}/burr/bones COMPONENT program)
endif()
# Public headers: these, and what they include. Every other header may change from one version to the next, and stays here.
set(BURR_PUBLIC base/check base/hash base/progress base/result base/version
  math/*  tool/*  scenario/*  workshop/prepare workshop/open_bone workshop/recording workshop/spared workshop/hand_device
  volume/bone volume/grid volume/tissue volume/sample volume/distance_to volume/thickness volume/volume_of
  volume/iso_vertices haptics/proxy haptics/touch_method haptics/force_law surface/mesher  # to touch and to show a bone without a session
  device/hand device/device device/simulated_hand device/pushed_hand device/replayed_hand
  tick/rows tick/command tick/servo
  phantom/build phantom/shapes phantom/phantoms io/read/read_scan importing/import io/export_part io/write/write_mesh
  surgeon/motion sim/session sim/session_words sim/replay
  record/recorder record/player record/timeline)
set(to_install "")
foreach(name ${BURR_PUBLIC})
  file(GLOB found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/burr/${name}.h)
  if(NOT found AND NOT name MATCHES "[*]$")
    message(FATAL_ERROR "cmake/install.cmake: there is no public header burr/${name}.h")
  endif()
  list(APPEND to_install ${found})
endforeach()
list(FILTER to_install EXCLUDE REGEX "/scenario/(built_in|rack_text|read_lesson|read_texts|read_tools|toml_reader)[.]h$")  # for their own room
set(BURR_INSTALLED "")
while(to_install)
  list(POP_FRONT to_install header)
  list(APPEND BURR_INSTALLED ${header})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header})
  file(STRINGS ${header} lines REGEX "^#include \"burr/|of this room only")
  foreach(line ${lines})
    if(line MATCHES "of this room only")
      message(FATAL_ERROR "cmake/install.cmake: ${header} is for its own room only, and a public header shows it")
    endif()
    string(REGEX REPLACE "^#include \"(.*)\".*$" "${PROJECT_SOURCE_DIR}/src/\\1" included "${line}")
    if(NOT included IN_LIST BURR_INSTALLED AND NOT included IN_LIST to_install)
      list(APPEND to_install ${included})
    endif()
  endforeach()
endwhile()
list(REMOVE_DUPLICATES BURR_INSTALLED)
foreach(header ${BURR_INSTALLED})
  file(RELATIVE_PATH inside ${PROJECT_SOURCE_DIR}/src ${header})
  get_filename_component(folder ${inside} DIRECTORY)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder} COMPONENT development)
endforeach()
install(EXPORT burrTargets NAMESPACE burr:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/burr COMPONENT development)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/burrConfig.cmake.in ${CMAKE_BINARY_DIR}/burrConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/burr)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/burrConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/burrConfig.cmake ${CMAKE_BINARY_DIR}/burrConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/burr COMPONENT development)
# examples to start from; the program contains them too
install(DIRECTORY ${PROJECT_SOURCE_DIR}/cases/ DESTINATION ${CMAKE_INSTALL_DATADIR}/burr/cases COMPONENT program FILES_MATCHING PATTERN "*.toml")
# the page, where it was built (cmake --build --preset web); `burr web` copies it
if(EXISTS ${CMAKE_BINARY_DIR}/../web/site/burr_page.wasm)
  install(DIRECTORY ${CMAKE_BINARY_DIR}/../web/site/ DESTINATION ${CMAKE_INSTALL_DATADIR}/burr/web COMPONENT program)
endif()
