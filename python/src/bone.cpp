// Bones, tissues, surfaces and distances.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

#include "burr/importing/import.h"
#include "burr/io/export_part.h"
#include "burr/io/scan.h"
#include "burr/io/write/write_mesh.h"
#include "burr/record/session_info.h"
#include "burr/surface/mesher.h"
#include "burr/surface/shells.h"
#include "burr/volume/distance_to.h"
#include "burr/volume/volume_of.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/prebuilt_phantom.h"
#include "common.h"

namespace burr::python {
namespace {

using volume::kBrickEdge;
using volume::kBrickVoxels;

constexpr int kThreads = 2;
constexpr const char* kKinds[] = {"air", "soft", "solid"};

volume::TissueKind kind_named(const std::string& name) {
  for (int n = 0; n < 3; ++n)
    if (name == kKinds[n]) return static_cast<volume::TissueKind>(n);
  raise(fmt::format("a tissue of kind \"{}\" is not known; use air, soft or solid", name));
}

// (z, y, x) of a bone, brick by brick. of(brick): (8 x 8 x 8) or nullptr
template <class T, class Of>
std::vector<T> dense(const volume::Bone& bone, T empty, const Of& of) {
  const math::Ijk size = bone.grid().size;
  const auto nx = static_cast<std::size_t>(size.x()), ny = static_cast<std::size_t>(size.y());
  std::vector<T> out(nx * ny * static_cast<std::size_t>(size.z()), empty);
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const T* from = of(brick);
    if (from == nullptr) continue;
    const math::Ijk first = bone.brick_ijk(brick), many = (size - first).cwiseMin(kBrickEdge);
    for (int z = 0; z < many.z(); ++z)
      for (int y = 0; y < many.y(); ++y)
        std::memcpy(&out[static_cast<std::size_t>(first.x()) +
                         nx * (static_cast<std::size_t>(first.y() + y) +
                               ny * static_cast<std::size_t>(first.z() + z))],
                    from + kBrickEdge * (y + kBrickEdge * z),
                    static_cast<std::size_t>(many.x()) * sizeof(T));
  }
  return out;
}

template <class T, class Of>
py::array dense_array(const BoneBox& box, T empty, const Of& of) {
  const math::Ijk size = box.bone->grid().size;
  std::vector<T> values;
  {
    const py::gil_scoped_release others_may;
    values = dense<T>(*box.bone, empty, of);
  }
  return as_array(std::move(values), {size.z(), size.y(), size.x()});
}

py::array hu(const BoneBox& box) {
  if (!box.bone->has_intensity())
    raise("this bone has no values of a scan: it was made from labels, a formula or a field");
  constexpr std::int16_t kAir = -1024;
  return dense_array<std::int16_t>(
      box, kAir, [&](volume::BrickIndex brick) { return box.bone->brick_intensity(brick); });
}

py::array brick_view(const py::object& self, volume::BrickIndex brick) {
  const auto& box = self.cast<const BoneBox&>();
  if (brick < 0 || brick >= box.bone->brick_count())
    throw py::index_error(fmt::format("brick {} of {}", brick, box.bone->brick_count()));
  static constexpr volume::BrickField kAir = {};
  const volume::Field* field = box.bone->brick_field(brick);
  constexpr py::ssize_t kOne = sizeof(volume::Field);
  return view(field != nullptr ? field : kAir.voxel, {kBrickEdge, kBrickEdge, kBrickEdge},
              {kOne * kBrickEdge * kBrickEdge, kOne * kBrickEdge, kOne}, self);
}

math::Ijk size_of(const py::array& array) {
  if (array.ndim() != 3)
    raise(fmt::format("the array has {} axes; a volume has three: z, y, x", array.ndim()));
  constexpr py::ssize_t kMost = 2048;
  for (int axis = 0; axis < 3; ++axis)
    if (array.shape(axis) < 1 || array.shape(axis) > kMost)
      raise(fmt::format("the array has {} voxels along an axis; use 1 to {}", array.shape(axis),
                        kMost));
  return {static_cast<int>(array.shape(2)), static_cast<int>(array.shape(1)),
          static_cast<int>(array.shape(0))};
}

template <class T>
using Dense = py::array_t<T, py::array::c_style>;

// An array of exactly this type; what: for the sentence.
template <class T>
Dense<T> exactly(const py::array& array, const char* what) {
  if (!py::dtype::of<T>().is(array.dtype()))
    raise(fmt::format("{} must be of type {}; this one is {}", what,
                      py::str(py::dtype::of<T>()).template cast<std::string>(),
                      py::str(array.dtype()).cast<std::string>()));
  return Dense<T>::ensure(array);
}

void same_shape(const py::array& one, const py::array& other) {
  if (size_of(one) != size_of(other)) raise("the arrays have different shapes");
}

BonePtr from_array(const py::array& field, double voxel_mm, const py::object& labels,
                   const std::vector<volume::Tissue>& tissues, const py::object& origin_mm,
                   std::size_t reserve_bricks) {
  const auto values = exactly<volume::Field>(field, "the field");
  if (!(voxel_mm > 1e-3 && voxel_mm < 100))
    raise(fmt::format("voxel_mm {} is out of range; use 0.001 to 100", voxel_mm));
  volume::Grid grid;
  grid.size = size_of(values);
  grid.voxel = 1e-3 * voxel_mm;
  grid.frame.p = 1e-3 * vec3_of(origin_mm, "origin_mm");
  volume::TissueTable table;
  if (!tissues.empty()) {
    if (tissues.size() > 256) raise("a bone has at most 256 tissues");
    table.tissues = tissues;
    if (table.tissues[0].kind != volume::TissueKind::air)
      raise("the first tissue must be of kind air: label 0 is air");
  }
  std::optional<Dense<volume::TissueId>> ids;
  if (!labels.is_none()) {
    ids = exactly<volume::TissueId>(py::array::ensure(labels), "labels");
    same_shape(values, *ids);
    const volume::TissueId* last = std::max_element(ids->data(), ids->data() + ids->size());
    if (*last >= table.tissues.size())
      raise(fmt::format("label {} has no tissue: {} are given", *last, table.tissues.size()));
  }
  const auto all = static_cast<std::size_t>(values.size());
  std::unique_ptr<volume::Bone> bone;
  {
    const py::gil_scoped_release others_may;
    bone = volume::bone_from_arrays(grid, std::move(table), {values.data(), all},
                                    ids ? std::span<const volume::TissueId>(ids->data(), all)
                                        : std::span<const volume::TissueId>(),
                                    {}, reserve_bricks);
  }
  return box(std::move(bone));
}

BonePtr imported(importing::Imported made, scenario::BoneRecipe recipe) {
  auto out = box(std::move(made.bone));
  out->recipe = std::move(recipe);
  out->format = made.summary.format;
  out->notices = std::move(made.summary.notices);
  return out;
}

struct ScanGrid {
  io::Scan scan;
  std::size_t voxels = 0;
};
// One number, or one for each axis.
math::Vec3 spacing_of(const py::object& spacing_mm) {
  const math::Vec3 mm =
      py::isinstance<py::float_>(spacing_mm) || py::isinstance<py::int_>(spacing_mm)
          ? math::Vec3(math::Vec3::Constant(spacing_mm.cast<double>()))
          : vec3_of(spacing_mm, "spacing_mm");
  if (!(mm.minCoeff() > 1e-3 && mm.maxCoeff() < 100))
    raise("spacing_mm is out of range; use 0.001 to 100, for x, y and z");
  return mm;
}

ScanGrid scan_like(const py::array& array, const py::object& spacing_mm,
                   const py::object& origin_mm) {
  ScanGrid made;
  made.scan.size = size_of(array);
  made.scan.spacing_mm = spacing_of(spacing_mm);
  made.scan.origin_mm = vec3_of(origin_mm, "origin_mm");
  made.scan.format = "array";
  made.voxels = static_cast<std::size_t>(array.size());
  return made;
}

// What the functions that make a bone have in common.
scenario::BoneRecipe recipe_from(double voxel_mm, const std::string& labels,
                                 const std::string& materials, std::size_t reserve_bricks) {
  scenario::BoneRecipe recipe;
  recipe.voxel_mm = voxel_mm;
  recipe.labels = labels;
  recipe.materials = materials;
  recipe.reserve_bricks = reserve_bricks;
  return recipe;
}

BonePtr import_scan(const io::Scan& scan, const scenario::BoneRecipe& recipe,
                    const py::object& call) {
  Work work(call);
  auto made = work.run([&] { return importing::import_bone(scan, recipe, work); });
  auto out = imported(take(std::move(made)), {});
  out->format = "array";
  return out;
}

BonePtr from_labels(const py::array& labels, const py::object& spacing_mm,
                    const std::map<int, std::string>& names, double voxel_mm,
                    const py::object& origin_mm, const std::string& materials,
                    std::size_t reserve_bricks, const py::object& call) {
  const auto values = exactly<std::uint8_t>(labels, "the labels");
  ScanGrid made = scan_like(values, spacing_mm, origin_mm);
  made.scan.labels.assign(values.data(), values.data() + made.voxels);
  for (const auto& [value, name] : names) {
    if (value < 1 || value > 255)
      raise(fmt::format("label {} is out of range; use 1 to 255", value));
    made.scan.label_names.push_back({.value = value, .name = name});
  }
  return import_scan(made.scan, recipe_from(voxel_mm, "", materials, reserve_bricks), call);
}

BonePtr from_hu(const py::array& hu, const py::object& spacing_mm, const py::object& iso,
                double voxel_mm, const py::object& origin_mm, const std::string& materials,
                std::size_t reserve_bricks, const py::object& call) {
  const auto values = Dense<float>::ensure(exactly<std::int16_t>(hu, "the values"));
  ScanGrid made = scan_like(values, spacing_mm, origin_mm);
  made.scan.values.assign(values.data(), values.data() + made.voxels);
  made.scan.hounsfield = true;
  scenario::BoneRecipe recipe = recipe_from(voxel_mm, "", materials, reserve_bricks);
  if (!iso.is_none()) recipe.iso = iso.cast<double>();
  return import_scan(made.scan, recipe, call);
}

BonePtr load(const std::string& source, double voxel_mm, const py::object& iso,
             const std::string& region, const std::string& series, const std::string& labels,
             const std::string& materials, const py::object& spacing_mm, double smooth,
             bool allow_missing, bool as_it_is, double read_seconds, double read_memory_mb,
             std::size_t reserve_bricks, const py::object& call) {
  scenario::BoneRecipe recipe = recipe_from(voxel_mm, labels, materials, reserve_bricks);
  recipe.source = source;
  recipe.series = series;
  recipe.allow_missing = allow_missing;
  recipe.as_it_is = as_it_is;
  if (smooth >= 0 && scenario::is_phantom(source))
    raise("a phantom is a formula without noise: `smooth` is for scans; leave it out");
  recipe.smooth = smooth;
  recipe.read_seconds = read_seconds;
  recipe.read_memory_mb = read_memory_mb;
  if (!spacing_mm.is_none()) recipe.spacing_mm = spacing_of(spacing_mm);
  if (!iso.is_none()) recipe.iso = iso.cast<double>();
  if (!region.empty()) recipe.region = take(scenario::parse_region(region));
  Work work(call);
  auto made = work.run([&] { return workshop::open_bone(recipe, work); });
  return imported(take(std::move(made)), recipe);
}

double volume_mm3(const BoneBox& box, const py::object& tissue) {
  if (tissue.is_none()) {
    const py::gil_scoped_release others_may;
    return 1e9 * volume::volume_of(*box.bone);
  }
  const auto& all = box.bone->tissues().tissues;
  const auto name = tissue.cast<std::string>();
  double sum = 0;
  bool found = false;
  for (std::size_t id = 1; id < all.size(); ++id) {
    if (all[id].name != name) continue;
    found = true;
    sum += volume::volume_of(*box.bone, static_cast<volume::TissueId>(id));
  }
  if (!found) raise(fmt::format("this bone has no tissue \"{}\"", name));
  return 1e9 * sum;
}

std::shared_ptr<MeshBox> surface_of(const BoneBox& box, const py::object& call) {
  Work work(call);
  auto mesh = take(work.run([&] { return surface::whole_surface(*box.bone, kThreads, work); }));
  return std::make_shared<MeshBox>(MeshBox{std::move(mesh), box.bone->tissues()});
}

io::Frame frame_named(const std::string& name) {
  if (name == "lps") return io::Frame::lps;
  if (name == "ras") return io::Frame::ras;
  if (name == "print") return io::Frame::print;
  raise(fmt::format("frame \"{}\" is not known; use lps, ras or print", name));
}

void export_bone(const BoneBox& now, const std::string& path, const std::string& part,
                 const BonePtr& before, const std::string& frame, bool largest, bool scan,
                 const py::object& call) {
  io::ExportOptions options{.frame = frame_named(frame), .scan = scan, .largest = largest};
  if (part == "removed")
    options.part = io::Part::removed;
  else if (part == "added")
    options.part = io::Part::added;
  else if (part != "bone")
    raise(fmt::format("part \"{}\" is not known; use bone, removed or added", part));
  if (options.part != io::Part::bone && before == nullptr)
    raise("give the bone as it was as `before`: what was removed or added is the difference");
  check(io::check_export(path, options));
  const volume::Bone& was = before != nullptr ? *before->bone : *now.bone;
  if (was.grid().size != now.bone->grid().size) raise("the two bones have different grids");
  Work work(call);
  take(work.run([&] { return io::export_part(was, *now.bone, path, options, work); }));
}

py::array points_of(const py::object& self, bool normals) {
  const auto& mesh = self.cast<const MeshBox&>().mesh;
  static const surface::Vertex kNone;
  const surface::Vertex& first = mesh.vertices.empty() ? kNone : mesh.vertices.front();
  return view(normals ? first.n.data() : first.p.data(),
              {static_cast<py::ssize_t>(mesh.vertices.size()), 3},
              {sizeof(surface::Vertex), sizeof(float)}, self);
}

void add_mesh(py::module_& module) {
  py::class_<MeshBox, std::shared_ptr<MeshBox>>(
      module, "Mesh", "The surface of a bone: triangles, closed. World, LPS [m].")
      .def_property_readonly(
          "points", [](const py::object& self) { return points_of(self, false); },
          "(n, 3) float32 [m]; a view that cannot be written")
      .def_property_readonly(
          "normals", [](const py::object& self) { return points_of(self, true); },
          "(n, 3) float32, out of the bone; a view")
      .def_property_readonly(
          "triangles",
          [](const py::object& self) {
            const auto& mesh = self.cast<const MeshBox&>().mesh;
            static constexpr std::uint32_t kNone = 0;
            constexpr py::ssize_t kOne = sizeof(std::uint32_t);
            return view(mesh.triangles.empty() ? &kNone : mesh.triangles.data(),
                        {static_cast<py::ssize_t>(mesh.triangles.size() / 3), 3}, {3 * kOne, kOne},
                        self);
          },
          "(m, 3) uint32, counter-clockwise from outside; a view")
      .def_property_readonly(
          "tissues",
          [](const py::object& self) {
            const auto& mesh = self.cast<const MeshBox&>().mesh;
            static const surface::Vertex kNone;
            const surface::Vertex& first = mesh.vertices.empty() ? kNone : mesh.vertices.front();
            return view(&first.tissue, {static_cast<py::ssize_t>(mesh.vertices.size())},
                        {sizeof(surface::Vertex)}, self);
          },
          "(n) uint8: the tissue at each point; a view")
      .def_property_readonly(
          "volume_mm3",
          [](const MeshBox& box) { return 1e9 * surface::shells_of(box.mesh).volume; })
      .def(
          "save",
          [](const MeshBox& box, const std::string& path, const std::string& frame) {
            Work work;
            check(work.run([&] {
              return io::write_mesh(box.mesh, box.tissues, path, frame_named(frame), work);
            }));
          },
          py::arg("path"), py::kw_only(), py::arg("frame") = "lps",
          "Writes .stl, .ply, .obj, .3mf or .glb.");
}

void add_distance(py::module_& module) {
  py::class_<volume::DistanceTo, std::shared_ptr<volume::DistanceTo>>(
      module, "Distance", "How far it is from any point to the nearest of some tissues.")
      .def(
          "at",
          [](const volume::DistanceTo& distance, const Dense<double>& points) {
            if (points.ndim() < 1 || points.shape(points.ndim() - 1) != 3)
              raise("points must have the shape (..., 3) [m]");
            std::vector<py::ssize_t> shape(points.shape(), points.shape() + points.ndim() - 1);
            const auto count = static_cast<std::size_t>(points.size() / 3);
            std::vector<double> out(count);
            for (std::size_t n = 0; n < count; ++n) {
              const double* p = points.data() + 3 * n;
              out[n] = distance.at(math::Vec3(p[0], p[1], p[2])).distance;
            }
            return as_array(std::move(out), std::move(shape));
          },
          py::arg("points"), "points (..., 3) [m] -> distances (...) [m]; inf beyond the reach")
      .def_property_readonly("reach_m", &volume::DistanceTo::reach);
}

std::shared_ptr<volume::DistanceTo> distance_to(const BoneBox& box,
                                                const std::vector<std::string>& names,
                                                double reach_mm, const py::object& call) {
  std::vector<volume::TissueId> wanted;
  const auto& all = box.bone->tissues().tissues;
  for (const std::string& name : names) {
    const std::size_t before = wanted.size();
    for (std::size_t id = 1; id < all.size(); ++id)
      if (all[id].name == name) wanted.push_back(static_cast<volume::TissueId>(id));
    if (wanted.size() == before) raise(fmt::format("this bone has no tissue \"{}\"", name));
  }
  volume::DistanceSettings settings;
  settings.reach = 1e-3 * reach_mm;
  Work work(call);
  return std::make_shared<volume::DistanceTo>(
      take(work.run([&] { return volume::DistanceTo::make(*box.bone, wanted, settings, work); })));
}

void add_tissue(py::module_& module) {
  py::class_<volume::Tissue>(module, "Tissue", "What a voxel is made of.")
      .def(py::init([](std::string name, const std::string& kind, double cutting_energy_j_m3,
                       double friction, bool spare, std::array<float, 3> colour) {
             volume::Tissue made;
             made.name = std::move(name);
             made.kind = kind_named(kind);
             made.cutting_energy = cutting_energy_j_m3;
             made.friction = friction;
             made.spare = spare;
             made.colour = colour;
             return made;
           }),
           py::arg("name") = "bone", py::kw_only(), py::arg("kind") = "solid",
           py::arg("cutting_energy_j_m3") = volume::Tissue{}.cutting_energy,
           py::arg("friction") = volume::Tissue{}.friction, py::arg("spare") = false,
           py::arg("colour") = volume::Tissue{}.colour)
      .def_readwrite("name", &volume::Tissue::name)
      .def_property(
          "kind",
          [](const volume::Tissue& tissue) { return kKinds[static_cast<int>(tissue.kind)]; },
          [](volume::Tissue& tissue, const std::string& kind) { tissue.kind = kind_named(kind); })
      .def_readwrite("cutting_energy_j_m3", &volume::Tissue::cutting_energy)
      .def_readwrite("friction", &volume::Tissue::friction)
      .def_readwrite("spare", &volume::Tissue::spare)
      .def_readwrite("colour", &volume::Tissue::colour)
      .def_readwrite("label", &volume::Tissue::label)
      .def("__repr__", [](const volume::Tissue& tissue) {
        return fmt::format("<burr.Tissue {}, {}>", tissue.name,
                           kKinds[static_cast<int>(tissue.kind)]);
      });
}

py::array points_turned(const BoneBox& box, const Dense<double>& points, bool to_world) {
  if (points.ndim() < 1 || points.shape(points.ndim() - 1) != 3)
    raise("points must have the shape (..., 3)");
  std::vector<double> out(static_cast<std::size_t>(points.size()));
  const volume::Grid& grid = box.bone->grid();
  for (std::size_t n = 0; n + 2 < out.size(); n += 3) {
    const math::Vec3 p(points.data()[n], points.data()[n + 1], points.data()[n + 2]);
    const math::Vec3 q = to_world ? grid.world_from_grid(p) : grid.grid_from_world(p);
    for (int axis = 0; axis < 3; ++axis) out[n + static_cast<std::size_t>(axis)] = q[axis];
  }
  return as_array(std::move(out), {points.shape(), points.shape() + points.ndim()});
}

}  // namespace

BonePtr box(std::unique_ptr<volume::Bone> bone) {
  auto made = std::make_shared<BoneBox>();
  made->bone = std::move(bone);
  made->format = "array";
  return made;
}

std::string hash_of(const volume::Bone& bone) {
  const py::gil_scoped_release others_may;
  return record::hex(bone.content_hash());
}

void add_bone(py::module_& module) {
  add_tissue(module);
  add_mesh(module);
  add_distance(module);
  using namespace py::literals;
  py::class_<BoneBox, BonePtr> bone(module, "Bone",
                                    "A bone of voxels. It never changes: a session cuts a copy.");
  bone.def_static("load", &load, "source"_a, py::kw_only(), "voxel_mm"_a = 0.0,
                  "iso"_a = py::none(), "region"_a = "", "series"_a = "", "labels"_a = "",
                  "materials"_a = "", "spacing_mm"_a = py::none(), "smooth"_a = -1.0,
                  "allow_missing"_a = false, "as_it_is"_a = false, "read_seconds"_a = 0.0,
                  "read_memory_mb"_a = 0.0, "reserve_bricks"_a = 4096, "progress"_a = py::none(),
                  "A file, a DICOM folder, or phantom:NAME.");
  bone.def_static("from_array", &from_array, "field"_a, "voxel_mm"_a, py::kw_only(),
                  "labels"_a = py::none(), "tissues"_a = std::vector<volume::Tissue>(),
                  "origin_mm"_a = py::make_tuple(0.0, 0.0, 0.0), "reserve_bricks"_a = 4096,
                  "field: uint16 (z, y, x): 0 air, 32768 surface, 65535 solid.");
  bone.def_static("from_labels", &from_labels, "labels"_a, "spacing_mm"_a, "names"_a, py::kw_only(),
                  "voxel_mm"_a = 0.0, "origin_mm"_a = py::make_tuple(0.0, 0.0, 0.0),
                  "materials"_a = "", "reserve_bricks"_a = 4096, "progress"_a = py::none(),
                  "labels: uint8 (z, y, x); made into bone as a label map from a file is.");
  bone.def_static("from_hu", &from_hu, "hu"_a, "spacing_mm"_a, py::kw_only(), "iso"_a = py::none(),
                  "voxel_mm"_a = 0.0, "origin_mm"_a = py::make_tuple(0.0, 0.0, 0.0),
                  "materials"_a = "", "reserve_bricks"_a = 4096, "progress"_a = py::none(),
                  "hu: int16 (z, y, x); made into bone as a CT from a file is.");
  bone.def_property_readonly("shape", [](const BoneBox& box) {
    const math::Ijk size = box.bone->grid().size;
    return py::make_tuple(size.z(), size.y(), size.x());
  });
  bone.def_property_readonly("voxel_mm",
                             [](const BoneBox& box) { return 1e3 * box.bone->grid().voxel; });
  bone.def_property_readonly(
      "origin_mm", [](const BoneBox& box) { return array_of(1e3 * box.bone->grid().frame.p); });
  bone.def_property_readonly("axes", [](const BoneBox& box) {
    const math::Mat3 axes = box.bone->grid().frame.q.toRotationMatrix();
    std::vector<double> rows;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) rows.push_back(axes(r, c));
    return as_array(std::move(rows), {3, 3});
  });
  bone.def_property_readonly("tissues",
                             [](const BoneBox& box) { return box.bone->tissues().tissues; });
  bone.def_property_readonly("bricks", [](const BoneBox& box) { return box.bone->brick_count(); });
  bone.def_property_readonly("hash", [](const BoneBox& box) { return hash_of(*box.bone); });
  bone.def_property_readonly("source", [](const BoneBox& box) { return box.recipe.source; });
  bone.def_property_readonly("format", [](const BoneBox& box) { return box.format; });
  bone.def_property_readonly("notices", [](const BoneBox& box) { return box.notices; });
  bone.def("brick", &brick_view, "number"_a, "(8, 8, 8) uint16; a view that cannot be written.");
  bone.def("field", [](const BoneBox& box) {
    return dense_array<volume::Field>(
        box, 0, [&](volume::BrickIndex brick) { return box.bone->brick_field(brick); });
  });
  bone.def("labels", [](const BoneBox& box) {
    return dense_array<volume::TissueId>(
        box, 0, [&](volume::BrickIndex brick) { return box.bone->brick_tissue(brick); });
  });
  bone.def("hu", &hu);
  bone.def("volume_mm3", &volume_mm3, "tissue"_a = py::none());
  bone.def(
      "world_from_index",
      [](const BoneBox& box, const Dense<double>& ijk) { return points_turned(box, ijk, true); },
      "ijk"_a, "(..., 3) voxels, x first -> (..., 3) [m]");
  bone.def(
      "index_from_world",
      [](const BoneBox& box, const Dense<double>& p) { return points_turned(box, p, false); },
      "points"_a);
  bone.def("distance_to", &distance_to, "tissues"_a, py::kw_only(), "reach_mm"_a = 20.0,
           "progress"_a = py::none());
  bone.def("surface", &surface_of, py::kw_only(), "progress"_a = py::none());
  bone.def("export", &export_bone, "path"_a, py::kw_only(), "part"_a = "bone",
           "before"_a = BonePtr(), "frame"_a = "lps", "largest"_a = false, "scan"_a = false,
           "progress"_a = py::none());
  bone.def(
      "save",
      [](const BoneBox& box, const std::string& path) {
        if (!workshop::is_whole_bone(path))
          raise(fmt::format("{}: the name must end in .bone", path));
        const py::gil_scoped_release others_may;
        check(workshop::write_prebuilt_phantom(*box.bone, path));
      },
      "path"_a, "A .bone file, which holds the bone to the bit; load() reads it.");
  bone.def("__repr__", [](const BoneBox& box) {
    const math::Ijk size = box.bone->grid().size;
    return fmt::format("<burr.Bone {} x {} x {} voxels of {:.3f} mm>", size.x(), size.y(), size.z(),
                       1e3 * box.bone->grid().voxel);
  });
}

}  // namespace burr::python
