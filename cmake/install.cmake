# `cmake --install` gives others a library: find_package(burr), target burr::burr
include(CMakePackageConfigHelpers)
install(TARGETS burr_core burr EXPORT burrTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS burr_read burr_guard RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/burr)
if(TARGET burr_program)
  set_target_properties(burr_program PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS burr_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(FILES ${BURR_BONES} DESTINATION ${CMAKE_INSTALL_DATADIR}/burr/bones)
endif()
foreach(header ${BURR_HEADERS})
  # a header whose first comment says "of this room only" is not installed; scripts/rooms.py checks
  # that no other room includes it
  file(READ ${header} greeting LIMIT 600)
  string(REGEX REPLACE "[/ \n]+" " " greeting "${greeting}")
  if(NOT greeting MATCHES "of this room only")
    file(RELATIVE_PATH inside ${PROJECT_SOURCE_DIR}/src ${header})
    get_filename_component(folder ${inside} DIRECTORY)
    install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder})
  endif()
endforeach()
install(EXPORT burrTargets NAMESPACE burr:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/burr)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/burrConfig.cmake.in ${CMAKE_BINARY_DIR}/burrConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/burr)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/burrConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/burrConfig.cmake ${CMAKE_BINARY_DIR}/burrConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/burr)
# examples to start from; the program contains them too
install(DIRECTORY ${PROJECT_SOURCE_DIR}/cases/ DESTINATION ${CMAKE_INSTALL_DATADIR}/burr/cases FILES_MATCHING PATTERN "*.toml")
