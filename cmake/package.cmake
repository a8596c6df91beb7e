# Packages for the Debian on which burr was built, 12 or 13: burr, libburr0, libburr-dev, python3-burr where the module was built,
# and burr-web, for every processor, where the page was built (scripts/package.sh).
# Which file goes where is the component of each install() in cmake/install.cmake.
set(BURR_PACKAGE_DIR ${CMAKE_BINARY_DIR}/package)

# What is made of the program itself, and compressed as Debian wants it. No part of `all`: it needs help2man.
add_custom_target(package_files
  COMMAND ${PROJECT_SOURCE_DIR}/packaging/files.sh $<TARGET_FILE:burr_program> ${BURR_PACKAGE_DIR}
  DEPENDS burr_program VERBATIM COMMENT "Manual pages and the other files of the packages")

set(share ${CMAKE_INSTALL_DATADIR})
foreach(section 1 7)
  install(DIRECTORY ${BURR_PACKAGE_DIR}/man${section} DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program OPTIONAL)
endforeach()
install(FILES ${BURR_PACKAGE_DIR}/70-burr.rules DESTINATION lib/udev/rules.d COMPONENT program OPTIONAL)
install(FILES ${BURR_PACKAGE_DIR}/org.burr.Burr.metainfo.xml DESTINATION ${share}/metainfo COMPONENT program OPTIONAL)
set(packaging ${PROJECT_SOURCE_DIR}/packaging)
install(FILES ${packaging}/completion/burr.bash DESTINATION ${share}/bash-completion/completions RENAME burr COMPONENT program)
install(FILES ${packaging}/completion/_burr DESTINATION ${share}/zsh/vendor-completions COMPONENT program)
install(FILES ${packaging}/completion/burr.fish DESTINATION ${share}/fish/vendor_completions.d COMPONENT program)
install(FILES ${packaging}/desktop/org.burr.Burr.desktop ${packaging}/desktop/org.burr.Burr.recording.desktop
  DESTINATION ${share}/applications COMPONENT program)
install(FILES ${packaging}/desktop/org.burr.Burr.mime.xml DESTINATION ${share}/mime/packages RENAME org.burr.Burr.xml COMPONENT program)
install(FILES ${packaging}/desktop/org.burr.Burr.svg DESTINATION ${share}/icons/hicolor/scalable/apps COMPONENT program)

set(packages program:burr library:libburr${PROJECT_VERSION_MAJOR} development:libburr-dev)
if(TARGET burr_python)
  list(APPEND packages python:python3-burr)
endif()
set(CPACK_COMPONENTS_ALL "")
if(EXISTS ${CMAKE_BINARY_DIR}/../web/published/version.json)
  list(APPEND packages web:burr-web)
endif()
foreach(one ${packages})
  string(REPLACE ":" ";" one ${one})
  list(GET one 0 component)
  list(GET one 1 package)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package})
  install(FILES ${packaging}/copyright ${BURR_PACKAGE_DIR}/changelog.Debian.gz
    DESTINATION ${share}/doc/${package} COMPONENT ${component} OPTIONAL)
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "burr")
set(CPACK_PACKAGE_CONTACT "The burr authors <burr@burr.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${packaging}/before_packing.cmake)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_SECTION science)

set(CPACK_COMPONENT_PROGRAM_DEPENDS library)
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS library)
set(CPACK_COMPONENT_PYTHON_DEPENDS library)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "simulator for cutting bone by hand, with touch at 1000 Hz
burr mills the bone of a patient's CT, or a synthetic one, with a haptic
device or a mouse. Cases with steps and scores, recordings that replay to
the bit, meshes to print.")
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "simulator for cutting bone by hand (library)
Bone, touch, cutting, recordings and pictures for other programs.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "simulator for cutting bone by hand (headers)
find_package(burr) with the targets burr::burr and burr::core.")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "simulator for cutting bone by hand (Python module)
Bones, sessions, recordings and scores from Python, with numpy.")
set(CPACK_COMPONENT_WEB_DESCRIPTION "simulator for cutting bone by hand (page for browsers)
burr compiled for browsers, ready for any web server: it mills, marks and
replays in the browser alone, and works without a network after the first
visit. Settings for nginx, Apache and Caddy lie beside it.")
set(CPACK_DEBIAN_WEB_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_WEB_PACKAGE_SECTION web)
set(CPACK_DEBIAN_WEB_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_WEB_PACKAGE_SUGGESTS "burr, nginx | httpd")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "fonts-inter")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "burr-web, ffmpeg, libgl1-mesa-dri, libegl1, libspnav0")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "parallel, slurm-client, postgresql")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
# what a program that was linked with them needs
file(WRITE ${CMAKE_BINARY_DIR}/package_control/shlibs
  "libburr ${PROJECT_VERSION_MAJOR} libburr${PROJECT_VERSION_MAJOR} (>= ${PROJECT_VERSION})\nlibburr_core ${PROJECT_VERSION_MAJOR} libburr${PROJECT_VERSION_MAJOR} (>= ${PROJECT_VERSION})\n")
file(WRITE ${CMAKE_BINARY_DIR}/package_control/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/package_control/shlibs ${CMAKE_BINARY_DIR}/package_control/triggers)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev")
math(EXPR next "0${Python_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next}), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "burr, libgl1-mesa-dri, libegl1")  # reports; pictures
include(CPack)
