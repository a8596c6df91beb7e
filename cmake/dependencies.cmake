# Everything comes from Debian 12 or 13; scripts/packages.txt is the list, docs/develop/decisions gives the
# reasons.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(ZLIB REQUIRED)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET epoxy)
pkg_check_modules(SDL2 REQUIRED IMPORTED_TARGET sdl2)
find_path(BURR_OPENXR_INCLUDE openxr/openxr.h REQUIRED)  # headers only: the loader is opened at run
                                                         # time
pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)  # the window's panels; for the program only
find_package(tomlplusplus QUIET)
if(NOT tomlplusplus_FOUND)
  pkg_check_modules(TOMLPP REQUIRED IMPORTED_TARGET tomlplusplus)
endif()
# reading scans: bzip2; GDCM decodes DICOM pixels (its own config file would pull in VTK)
find_package(BZip2 REQUIRED)
find_package(OpenSSL 3 REQUIRED)  # TLS of `burr serve`
find_package(PNG REQUIRED)  # pictures of AMBF's volumes; stb only writes
pkg_check_modules(YAML REQUIRED IMPORTED_TARGET yaml-0.1)  # and their description
find_package(meshoptimizer REQUIRED)
pkg_check_modules(ASSIMP REQUIRED IMPORTED_TARGET assimp)  # in tests alone: reads back the meshes that burr writes, and reads what burr reads
find_path(BURR_GDCM_INCLUDE gdcmImageReader.h PATH_SUFFIXES gdcm-3.0 REQUIRED)
find_library(BURR_GDCM_MSFF gdcmMSFF REQUIRED)
find_library(BURR_GDCM_DSED gdcmDSED REQUIRED)
find_library(BURR_GDCM_COMMON gdcmCommon REQUIRED)
add_library(burr_gdcm INTERFACE)
target_include_directories(burr_gdcm SYSTEM INTERFACE ${BURR_GDCM_INCLUDE})
target_link_libraries(burr_gdcm INTERFACE ${BURR_GDCM_MSFF} ${BURR_GDCM_DSED} ${BURR_GDCM_COMMON})
# writing DICOM segmentations; its own config file would link all of its libraries
find_path(BURR_DCMTK_INCLUDE dcmtk/dcmseg/segdoc.h REQUIRED)
add_library(burr_dcmtk INTERFACE)
target_include_directories(burr_dcmtk SYSTEM INTERFACE ${BURR_DCMTK_INCLUDE})
foreach(library dcmseg dcmfg dcmiod dcmdata oflog ofstd)
  find_library(BURR_DCMTK_${library} ${library} REQUIRED)
  target_link_libraries(burr_dcmtk INTERFACE ${BURR_DCMTK_${library}})
endforeach()
pkg_check_modules(HDF5 REQUIRED IMPORTED_TARGET hdf5-serial)  # data sets for programs that learn; for the program only
# the store of learners: a file, or a centre's server
pkg_check_modules(SQLITE REQUIRED IMPORTED_TARGET sqlite3)
pkg_check_modules(POSTGRES REQUIRED IMPORTED_TARGET libpq)
# the bus of ROS 2, which CRTK arms use; idlc generates C from the messages
find_package(CycloneDDS REQUIRED)
find_program(BURR_IDLC idlc REQUIRED)
