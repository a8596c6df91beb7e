# The messages of CRTK (ROS 2) as C, generated from their IDL, for the library and for burr-guard.
set(idl ${PROJECT_SOURCE_DIR}/src/burr/device/crtk/crtk_messages.idl)
set(made ${CMAKE_BINARY_DIR}/crtk)
add_custom_command(OUTPUT ${made}/crtk_messages.c ${made}/crtk_messages.h
  COMMAND ${CMAKE_COMMAND} -E make_directory ${made}
  COMMAND ${BURR_IDLC} -l c -o ${made} ${idl}
  DEPENDS ${idl} COMMENT "Messages of CRTK" VERBATIM)
# a definition that our code does not use; it would prevent the common headers (options.cmake)
set_property(TARGET CycloneDDS::ddsc PROPERTY INTERFACE_COMPILE_DEFINITIONS "")
add_library(burr_crtk STATIC ${made}/crtk_messages.c ${made}/crtk_messages.h)
target_include_directories(burr_crtk SYSTEM PUBLIC ${made})
target_link_libraries(burr_crtk PUBLIC CycloneDDS::ddsc)

# burr-guard: releases the force of a device if burr dies (src/burr/device/guardian.h); small, so
# that it starts at once
add_executable(burr_guard ${PROJECT_SOURCE_DIR}/apps/burr-guard/main.cpp
  ${PROJECT_SOURCE_DIR}/src/burr/device/crtk/bus.cpp ${PROJECT_SOURCE_DIR}/src/burr/device/crtk/reach.cpp ${PROJECT_SOURCE_DIR}/src/burr/base/check.cpp)
set_target_properties(burr_guard PROPERTIES OUTPUT_NAME burr-guard RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
target_include_directories(burr_guard PRIVATE ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(burr_guard PRIVATE burr_crtk Eigen3::Eigen Threads::Threads fmt::fmt burr_options)
