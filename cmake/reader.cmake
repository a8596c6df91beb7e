# burr-read: reads one scan or one mesh in a process of its own (src/burr/io/sandbox/fence.h). It contains the
# readers and what they need, so it starts in milliseconds. libburr contains only what both sides
# need, and no codec.
include(cmake/letters.cmake)
file(GLOB base CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/burr/base/*.cpp)
# its class has virtual functions, so a program that links both libraries would have two tables of them; no reader needs it
list(FILTER base EXCLUDE REGEX one_bar)
set(BURR_BOTH_SIDES
  io/read/adf_folder.cpp io/read/bytes.cpp io/read/calibration.cpp io/read/label_lists.cpp io/read/label_numbers.cpp io/sandbox/fence_letter.cpp io/sandbox/fence_walls.cpp io/read/samples.cpp io/read/text.cpp io/value_groups.cpp io/voxels.cpp)
set(BURR_READERS io/read/archive.cpp io/read/beside.cpp io/read/compare_frames.cpp io/read/contour_plane.cpp io/read/contour_voxels.cpp
  io/read/dicom_absent.cpp io/read/dicom_contours.cpp io/read/dicom_divide.cpp io/read/dicom_elements.cpp io/read/dicom_facts.cpp
  io/read/dicom_header.cpp io/read/dicom_labels.cpp io/read/dicom_pixels.cpp io/read/dicom_seg.cpp io/read/dicom_seg_frames.cpp
  io/read/dicom_series.cpp io/read/dicom_slices.cpp io/read/dicom_stack.cpp io/read/dicom_syntaxes.cpp io/read/dicom_volumes.cpp
  io/read/dicomdir.cpp io/read/foreign.cpp io/read/geometry.cpp io/read/grey_picture.cpp io/read/inverted.cpp io/read/letters.cpp
  io/read/merge_structures.cpp io/read/mesh_builder.cpp io/read/mesh_text.cpp io/read/modality.cpp io/read/nrrd_header.cpp
  io/read/nrrd_segments.cpp io/read/nrrd_shape.cpp io/read/picture_scale.cpp io/read/picture_stack.cpp io/read/ply_header.cpp
  io/read/png.cpp io/read/polygon.cpp io/read/read_adf.cpp io/read/read_dicom.cpp io/read/read_mesh_unfenced.cpp io/read/read_meta.cpp
  io/read/read_nifti.cpp io/read/read_nrrd.cpp io/read/read_obj.cpp io/read/read_ply.cpp io/read/read_stl.cpp io/read/read_unfenced.cpp
  io/read/several_volumes.cpp io/read/stack_names.cpp io/read/tiff.cpp io/read/volume_folder.cpp io/read/yaml.cpp io/sandbox/fence_child.cpp)
list(TRANSFORM BURR_BOTH_SIDES PREPEND ${PROJECT_SOURCE_DIR}/src/burr/)
list(TRANSFORM BURR_READERS PREPEND ${PROJECT_SOURCE_DIR}/src/burr/)

add_library(burr_readers STATIC ${BURR_READERS} ${BURR_BOTH_SIDES} ${base})
target_include_directories(burr_readers PUBLIC ${PROJECT_SOURCE_DIR}/src)
target_include_directories(burr_readers PRIVATE ${BURR_LETTERS})
target_link_libraries(burr_readers PUBLIC Eigen3::Eigen Threads::Threads fmt::fmt ZLIB::ZLIB BZip2::BZip2 burr_gdcm PNG::PNG TIFF::TIFF PkgConfig::YAML
  PRIVATE burr_options)
target_compile_definitions(burr_readers PRIVATE BURR_VERSION="${PROJECT_VERSION}")
burr_common_headers(burr_readers <fmt/format.h>)

add_executable(burr_read ${PROJECT_SOURCE_DIR}/apps/burr-read/main.cpp)
set_target_properties(burr_read PROPERTIES OUTPUT_NAME burr-read RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
target_link_libraries(burr_read PRIVATE burr_readers burr_options)

# burr-seg: writes one DICOM segmentation in a process of its own, because DCMTK must not be loaded into the program that
# runs a device.
set(BURR_SEG_SOURCES ${PROJECT_SOURCE_DIR}/src/burr/io/write/dicom_seg_child.cpp)
add_executable(burr_seg ${PROJECT_SOURCE_DIR}/apps/burr-seg/main.cpp ${BURR_SEG_SOURCES})
set_target_properties(burr_seg PROPERTIES OUTPUT_NAME burr-seg RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
target_include_directories(burr_seg PRIVATE ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(burr_seg PRIVATE burr_dcmtk nlohmann_json::nlohmann_json burr_options)

# where an installation has it, relative to libburr.so
file(RELATIVE_PATH BURR_LIBEXEC_FROM_LIB ${CMAKE_INSTALL_FULL_LIBDIR} ${CMAKE_INSTALL_FULL_LIBEXECDIR}/burr)
