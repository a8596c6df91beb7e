// A custom tool whose part is a mesh: from the list of tools to the recording.
#include "burr/workshop/mesh_shape.h"

#include <gtest/gtest.h>

#include <fstream>

#include "burr/record/tool_json.h"
#include "burr/tool/shape_grid.h"
#include "support/folder.h"
#include "support/mesh.h"

namespace burr::workshop {
namespace {

using math::Vec3;

// ASCII STL, every face with corners of its own and 7 digits, as most programs write it.
void write_stl(const std::string& path, const tool::Triangles& mesh, double scale) {
  std::ofstream out(path);
  out.precision(7);
  out << "solid punch\n";
  for (const auto& face : mesh.faces) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t n : face)
      out << "vertex " << scale * mesh.points[n].x() << ' ' << scale * mesh.points[n].y() << ' '
          << scale * mesh.points[n].z() << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid punch\n";
}

constexpr const char* kPunch = R"([[tool]]
name = "punch"
title = "Punch"
drive = "pushed"
way = [0, 0, -1]
[[tool.part]]
shape = "mesh"
role = "cuts"
file = "punch.stl"
at_mm = [0, 0, 2]
)";

class MeshShapeTest : public testing::Test {
 protected:
  Result<scenario::Rack> rack(const std::string& text = kPunch) {
    std::ofstream(folder_ / "mine.toml") << text;
    return scenario::read_rack(folder_ / "mine.toml", mesh_shape);
  }
  std::string why(const std::string& text = kPunch) {
    const auto read = rack(text);
    return read.ok() ? std::string() : read.error().text;
  }
  test::Folder folder_;
  tool::Triangles punch_ = test::turned({{0, -3}, {1, -3}, {2, 3}, {0, 3}}, 64);
};

TEST_F(MeshShapeTest, AToolFromAMeshIsTheBodyOfTheMesh) {
  write_stl(folder_ / "punch.stl", punch_, 1);
  const auto read = rack();
  ASSERT_TRUE(read.ok()) << read.error().text;
  const tool::Part& part = read->find("punch")->tool.parts[0];
  const tool::Shape truth = {tool::ShapeKind::frustum, 1e-3, 2e-3, 3e-3, 0};
  for (const Vec3& mm :
       {Vec3(0.5, 0, 5.2), Vec3(1.6, 0.8, 3), Vec3(0, -1.7, 2), Vec3(0.1, 0, -1.2)}) {
    const Vec3 p = 1e-3 * mm;
    const Vec3 in_part = part.tool_from_part.q.conjugate() * (p - part.tool_from_part.p);
    EXPECT_NEAR(1e3 * tool::distance(part.shape, in_part).phi,
                1e3 * tool::distance(truth, p - Vec3(0, 0, 2e-3)).phi, 0.02)
        << mm.transpose();
  }
  EXPECT_NEAR(1e3 * scenario::cutting_width(*read->find("punch")), 4, 0.3);
}

TEST_F(MeshShapeTest, TheUnitOfTheFileMayBeAnother) {
  write_stl(folder_ / "punch.stl", punch_, 0.1);  // in cm
  std::string text = kPunch;
  text += "mm_per_unit = 10\n";
  const auto read = rack(text);
  ASSERT_TRUE(read.ok()) << read.error().text;
  EXPECT_NEAR(1e3 * scenario::cutting_width(*read->find("punch")), 4, 0.3);
}

TEST_F(MeshShapeTest, ARecordingHoldsTheMeshWhole) {
  write_stl(folder_ / "punch.stl", punch_, 1);
  const auto read = rack();
  ASSERT_TRUE(read.ok());
  const scenario::RackTool& punch = *read->find("punch");
  const std::string text = record::tools_to_json({{punch.name, punch.tool, punch.cutter}});
  std::vector<tool::ShapedTool> back;
  ASSERT_TRUE(record::tools_from_json(text, back));
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].tool.parts[0].shape.grid, punch.tool.parts[0].shape.grid);
  EXPECT_EQ(back[0].tool.parts[0].shape.a, punch.tool.parts[0].shape.a);
  EXPECT_EQ(record::tools_to_json(back), text);
  // and one that is damaged is no tool
  for (const auto& [from, to] :
       {std::pair("\"phi\":[", "\"phi\":[40000,"), std::pair("\"phi\":[", "\"phi\":[1,"),
        std::pair("\"size\":[", "\"size\":[1,")}) {
    std::string broken = text;
    broken.replace(broken.find(from), std::string(from).size(), to);
    std::vector<tool::ShapedTool> none;
    EXPECT_FALSE(record::tools_from_json(broken, none)) << to;
  }
}

TEST_F(MeshShapeTest, AMistakeIsOneSentenceWithFileAndField) {
  EXPECT_NE(why().find("mine.toml: line 9: tool[1].part[1].file: punch.stl: cannot be opened"),
            std::string::npos)
      << why();
  std::ofstream(folder_ / "punch.stl") << "this is a letter";
  EXPECT_NE(why().find("this is no stl mesh"), std::string::npos) << why();
  tool::Triangles open = punch_;
  open.faces.pop_back();
  write_stl(folder_ / "punch.stl", open, 1);
  EXPECT_NE(why().find("punch.stl: the mesh has 3 open edges"), std::string::npos) << why();
  write_stl(folder_ / "punch.stl", test::box_mesh({10, 10, 0.2}, Vec3::Zero()), 1);
  EXPECT_NE(why(std::string(kPunch) + "cell_mm = 0.35\n").find("too coarse"), std::string::npos)
      << why(std::string(kPunch) + "cell_mm = 0.35\n");
  std::string other = kPunch;
  other.replace(other.find("punch.stl"), 9, "punch.fbx");
  EXPECT_NE(why(other).find("as STL, OBJ or PLY"), std::string::npos) << why(other);
  const auto without = scenario::read_rack(folder_ / "mine.toml");
  ASSERT_FALSE(without.ok());
}

}  // namespace
}  // namespace burr::workshop
