// Meshes of triangles, read behind the fence: compared with assimp and with formulas, and files that
// promise what they do not hold.
#include "burr/io/read/read_mesh.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "burr/io/read/polygon.h"
#include "burr/io/sandbox/fence.h"
#include "burr/math/vec3.h"
#include "io/folder_of_test.h"
#include "support/test_places.h"

namespace burr::io {
namespace {

using Corner = std::array<float, 3>;
using Faces = std::vector<std::vector<std::uint32_t>>;

struct Body {
  std::vector<Corner> points;
  Faces faces;
};

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& face : mesh.faces) {
    math::Vec3 p[3];
    for (std::size_t n = 0; n < 3; ++n)
      p[n] = {mesh.points[face[n]][0], mesh.points[face[n]][1], mesh.points[face[n]][2]};
    sum += p[0].dot(p[1].cross(p[2])) / 6;
  }
  return sum;
}

// A prism over an outline, whose two ends are one face each.
Body prism(const std::vector<std::pair<float, float>>& outline, float height) {
  Body body;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const float z : {0.0F, height})
    for (const auto& [x, y] : outline) body.points.push_back({x, y, z});
  body.faces.resize(2);
  for (std::uint32_t c = 0; c < n; ++c) {
    body.faces[0].push_back(n - 1 - c);
    body.faces[1].push_back(n + c);
    body.faces.push_back({c, (c + 1) % n, n + (c + 1) % n, n + c});
  }
  return body;
}

std::string number(float x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", double{x});
  return text;
}
std::string line(const Corner& p) { return number(p[0]) + " " + number(p[1]) + " " + number(p[2]); }

std::string obj(const Body& body) {
  std::string text = "# made by a test\no body\n";
  for (const Corner& p : body.points) text += "v " + line(p) + "\n";
  text += "vn 0 0 1\n";
  for (const auto& face : body.faces) {
    text += "f";
    for (const std::uint32_t c : face) text += " " + std::to_string(c + 1) + "//1";
    text += "\n";
  }
  return text;
}

template <class T>
std::string bytes(T value, bool big) {
  std::string out(sizeof value, '\0');
  std::memcpy(out.data(), &value, sizeof value);
  if (big) std::reverse(out.begin(), out.end());
  return out;
}

std::string ply(const Body& body, const std::string& form) {
  std::string text = "ply\nformat " + form + " 1.0\ncomment by a test\nelement vertex " +
                     std::to_string(body.points.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
                     "element face " +
                     std::to_string(body.faces.size()) +
                     "\nproperty list uchar int vertex_indices\nend_header\n";
  const bool big = form == "binary_big_endian";
  if (form == "ascii") {
    for (const Corner& p : body.points) text += line(p) + " 200\n";
    for (const auto& face : body.faces) {
      text += std::to_string(face.size());
      for (const std::uint32_t c : face) text += " " + std::to_string(c);
      text += "\n";
    }
    return text;
  }
  for (const Corner& p : body.points) {
    for (const float x : p) text += bytes(x, big);
    text += '\xc8';
  }
  for (const auto& face : body.faces) {
    text += static_cast<char>(face.size());
    for (const std::uint32_t c : face) text += bytes(static_cast<std::int32_t>(c), big);
  }
  return text;
}

std::string stl(const TriangleMesh& mesh, bool words) {
  std::string text =
      words ? "solid a test\n" : "solid in spite of its bytes" + std::string(53, ' ');
  if (!words) text += bytes(static_cast<std::uint32_t>(mesh.faces.size()), false);
  for (const auto& face : mesh.faces) {
    text += words ? "facet normal 0 0 0\nouter loop\n" : std::string(12, '\0');
    for (const std::uint32_t c : face) {
      if (words) text += "vertex " + line(mesh.points[c]) + "\n";
      for (const float x : mesh.points[c])
        if (!words) text += bytes(x, false);
    }
    text += words ? "endloop\nendfacet\n" : std::string(2, '\0');
  }
  return words ? text + "endsolid a test\n" : text;
}

class ReadMesh : public test::FolderTest {
 protected:
  Result<TriangleMesh> read(const std::string& name, const std::string& content) {
    std::ofstream(path(name), std::ios::binary) << content;
    return read_mesh(path(name));
  }
  std::string why(const std::string& name, const std::string& content) {
    const auto start = std::chrono::steady_clock::now();
    const auto mesh = read(name, content);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(40)) << name;
    return mesh.ok() ? "(a mesh)" : mesh.error().text;
  }
  // Triangles of the same file as assimp sees them, each corner in its place.
  std::vector<std::array<Corner, 3>> by_assimp(const std::string& name) const {
    Assimp::Importer importer;
    const aiScene* scene =
        importer.ReadFile(path(name), aiProcess_Triangulate | aiProcess_PreTransformVertices);
    std::vector<std::array<Corner, 3>> out;
    EXPECT_NE(scene, nullptr) << importer.GetErrorString();
    if (scene == nullptr) return out;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m)
      for (unsigned f = 0; f < scene->mMeshes[m]->mNumFaces; ++f) {
        std::array<Corner, 3> face{};
        for (unsigned c = 0; c < 3; ++c) {
          const aiVector3D& p =
              scene->mMeshes[m]->mVertices[scene->mMeshes[m]->mFaces[f].mIndices[c]];
          face[c] = {p.x, p.y, p.z};
        }
        out.push_back(face);
      }
    return out;
  }
};

const std::vector<std::pair<float, float>> kEll = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 4}, {0, 4}};

TEST_F(ReadMesh, AHollowOutlineKeepsItsVolumeInEveryForm) {
  const Body ell = prism(kEll, 2);
  const double truth = 2 * 6;
  for (const auto& [name, text] : {std::pair<std::string, std::string>("a.obj", obj(ell)),
                                   {"a.ply", ply(ell, "ascii")},
                                   {"b.ply", ply(ell, "binary_little_endian")},
                                   {"c.PLY", ply(ell, "binary_big_endian")}}) {
    const auto mesh = read(name, text);
    ASSERT_TRUE(mesh.ok()) << mesh.error().text;
    EXPECT_EQ(mesh->points.size(), 12U) << name;
    EXPECT_EQ(mesh->faces.size(), 2 * 4 + 6 * 2U) << name;
    EXPECT_NEAR(volume(*mesh), truth, 1e-6) << name;
    for (const bool words : {true, false}) {
      const auto again = read("again.stl", stl(*mesh, words));
      ASSERT_TRUE(again.ok()) << again.error().text;
      EXPECT_EQ(again->faces.size(), mesh->faces.size());
      EXPECT_NEAR(volume(*again), truth, 1e-6);
    }
  }
}

// The same triangles to the bit, in the same order, as a program reads them that has nothing to do with
// burr: bodies of random outlines around a middle.
TEST_F(ReadMesh, AssimpReadsTheSame) {
  const unsigned seed = 4711;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> far(0.5F, 20.0F);
  for (int round = 0; round < 8; ++round) {
    std::vector<std::pair<float, float>> outline;
    double twice = 0;
    const int corners = 3 + round;
    for (int n = 0; n < corners; ++n) {
      const float r = far(random), a = 2 * std::numbers::pi_v<float> * static_cast<float>(n) /
                                       static_cast<float>(corners);
      outline.emplace_back(r * std::cos(a), r * std::sin(a));
    }
    for (std::size_t n = 0; n < outline.size(); ++n) {
      const auto& [x, y] = outline[n];
      const auto& [u, v] = outline[(n + 1) % outline.size()];
      twice += double{x} * v - double{u} * y;
    }
    const Body body = prism(outline, 3);
    const auto mesh = read("a.obj", obj(body));
    ASSERT_TRUE(mesh.ok()) << mesh.error().text;
    EXPECT_NEAR(volume(*mesh) / (3 * twice / 2), 1, 1e-5);
    for (const std::string& name :
         {std::string("b.stl"), std::string("c.stl"), std::string("d.ply")}) {
      Body triangles{mesh->points, {}};
      for (const auto& f : mesh->faces) triangles.faces.push_back({f[0], f[1], f[2]});
      const auto ours = read(name, name == "d.ply" ? ply(triangles, "binary_little_endian")
                                                   : stl(*mesh, name == "b.stl"));
      ASSERT_TRUE(ours.ok()) << ours.error().text;
      const auto theirs = by_assimp(name);
      ASSERT_EQ(ours->faces.size(), theirs.size()) << name;
      for (std::size_t f = 0; f < theirs.size(); ++f)
        for (std::size_t c = 0; c < 3; ++c)
          for (std::size_t a = 0; a < 3; ++a)  // assimp reads decimals to the last bit or two
            EXPECT_NEAR(ours->points[ours->faces[f][c]][a], theirs[f][c][a],
                        name == "b.stl" ? 4e-6 : 0)
                << name;
    }
  }
}

TEST_F(ReadMesh, ObjAsProgramsWriteIt) {
  const auto mesh = read("a.obj",
                         "mtllib /etc/passwd\r\nv 0 0 0 1\r\nv 1 0 0\r\nv 0 1 0\r\nv 0 0 +1e0\r\n"
                         "l 1 2\r\nf 1/1/1 3/2 2//1 # the lower\r\nf -4 -3 -1\r\n"
                         "f 2 \\\r\n 3 4\r\nf 1 4 3");
  ASSERT_TRUE(mesh.ok()) << mesh.error().text;
  EXPECT_EQ(mesh->faces.size(), 4U);
  EXPECT_NEAR(volume(*mesh), 1.0 / 6, 1e-7);
}

// Ears: the triangles cover the outline once, whatever its form and direction.
TEST(Polygon, TrianglesCoverTheOutlineOnce) {
  const unsigned seed = 99;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0.05, 1), turn(-1, 1);
  for (int round = 0; round < 200; ++round) {
    const math::Vec3 u = math::Vec3(turn(random), turn(random), turn(random)).normalized();
    const math::Vec3 v = u.cross(math::Vec3(turn(random), turn(random), 2)).normalized();
    std::vector<Corner> corners;
    math::Vec3 whole = math::Vec3::Zero();
    const int count = 3 + round % 30;
    for (int n = 0; n < count; ++n) {
      const double r = share(random), a = 2 * M_PI * n / count;
      const math::Vec3 p = r * std::cos(a) * u + r * std::sin(a) * v;
      corners.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    }
    const auto at = [&](std::size_t n) {
      return math::Vec3(corners[n][0], corners[n][1], corners[n][2]);
    };
    for (std::size_t n = 0; n < corners.size(); ++n)
      whole += at(n).cross(at((n + 1) % corners.size())) / 2;
    double area = 0;
    const auto triangles = triangles_of(corners);
    ASSERT_EQ(triangles.size(), corners.size() - 2);
    for (const auto& [a, b, c] : triangles) area += (at(b) - at(a)).cross(at(c) - at(a)).norm() / 2;
    EXPECT_NEAR(area, whole.norm(), 1e-5) << "round " << round;
  }
}

const std::string kPlyHead = "ply\nformat ascii 1.0\n";
const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kList = "property list uchar int vertex_indices\n";

// Files of a dozen lines that promise gigabytes, or name what is not there.
TEST_F(ReadMesh, APromiseThatTheFileDoesNotKeepIsASentence) {
  const std::string four = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  const std::string count = "element vertex 4\n";
  const struct {
    std::string name, text, says;
  } cases[] = {
      {"many_points.ply",
       kPlyHead + "element vertex 4000000000\n" + kXyz + "element face 1\n" + kList +
           "end_header\n" + four + "3 0 1 2\n",
       "it says 4000000000 of vertex and is too short for them"},
      {"many_faces.ply",
       kPlyHead + count + kXyz + "element face 999999999999\n" + kList + "end_header\n" + four +
           "3 0 1 2\n",
       "it says 999999999999 of face"},
      {"long_list.ply",
       kPlyHead + count + kXyz +
           "element face 1\nproperty list uint int vertex_indices\nend_header\n" + four +
           "4294967295 0 1 2\n",
       "face 1: a list is longer than the file"},
      {"list_of_others.ply",
       kPlyHead + count + kXyz + "element strips 1\nproperty list int int x\nend_header\n" + four +
           "2147483647 0\n",
       "strips 1: a list is longer"},
      {"below_none.ply",
       kPlyHead + count + kXyz + "element face 1\nproperty list char int vertex_indices\n" +
           "end_header\n" + four + "-1 0 1 2\n",
       "the length of a list is no count"},
      {"no_such_point.ply",
       kPlyHead + count + kXyz + "element face 1\n" + kList + "end_header\n" + four + "3 0 1 9\n",
       "face 1 names point 9, and there are 4"},
      {"point_below_none.ply",
       kPlyHead + count + kXyz + "element face 1\n" + kList + "end_header\n" + four + "3 0 1 -1\n",
       "it names a point that cannot be"},
      {"no_points.ply", kPlyHead + "element face 1\n" + kList + "end_header\n3 0 1 2\n",
       "it has no points"},
      {"points_without_z.ply",
       kPlyHead + "element vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
       "it has no points"},
      {"nothing_said.ply", kPlyHead + "element vertex 9223372036854775807\nend_header\n",
       "it has no points"},
      {"float_count.ply",
       kPlyHead + "element face 1\nproperty list float int vertex_indices\nend_header\n1\n",
       "the length of a list needs a type of whole numbers"},
      {"no_end.ply", kPlyHead + count + kXyz, "its head does not end"},
      {"not_a_number.ply",
       kPlyHead + count + kXyz + "element face 1\n" + kList + "end_header\nnan 0 0\n1 0 0\n" +
           "0 1 0\n0 0 1\n3 0 1 2\n",
       "the mesh has a point that is not a number"},
      {"too_far.obj", "v 0 0 1e300\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
       "the mesh has a point that is not a number"},
      {"no_such_point.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n",
       "line 3: a face names point 3, and 2 are known there"},
      {"none.obj", "v 0 0 0\nv 1 0 0\nf 1 2 0\n", "a face names point 0"},
      {"far_back.obj", "v 0 0 0\nv 1 0 0\nf 1 2 -9223372036854775807\n", "a face names point -92"},
      {"empty.obj", "", "this is no obj mesh (it has no points)"},
      {"letter.stl", "this is a letter", "this is no stl mesh"},
      {"letter_of_length.stl", std::string(80, 'x') + std::string(4, '\xff') + "yyyy",
       "it says 4294967295 triangles and holds 0"},
      {"half.stl", "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\n",
       "the file ends within a triangle"},
      {"a.fbx", "v", "burr reads meshes as STL, OBJ or PLY"},
  };
  for (const auto& one : cases) {
    const std::string said = why(one.name, one.text);
    EXPECT_NE(said.find(one.says), std::string::npos) << one.name << ": " << said;
    EXPECT_EQ(said.find(one.name), 0U) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  if (fence_state().memory_limit) {
    EXPECT_LT(usage.ru_maxrss, 300 * 1024) << "KiB";
  }
}

TEST_F(ReadMesh, LimitsAreSentences) {
  std::string many = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (std::size_t n = 0; n <= kMostTriangles; ++n) many += "f 1 2 3\n";
  EXPECT_NE(why("many.obj", many).find("more than 2000000 triangles; simplify it"),
            std::string::npos);
  std::string wide = "v 0 0 0\nf";
  for (std::size_t n = 0; n <= kMostCorners; ++n) wide += " 1";
  EXPECT_NE(why("wide.obj", wide).find("a face with 4097 corners"), std::string::npos);
  std::ofstream(path("large.stl")) << "solid";
  std::filesystem::resize_file(path("large.stl"), kLargestMesh + (1 << 20));
  const auto large = read_mesh(path("large.stl"));
  ASSERT_FALSE(large.ok());
  EXPECT_NE(large.error().text.find("the mesh has 65 MB, burr reads up to 64 MB"),
            std::string::npos)
      << large.error().text;
}

TEST_F(ReadMesh, NoPipeIsWaitedFor) {
  ASSERT_EQ(::mkfifo(path("a.stl").c_str(), 0600), 0);
  const auto mesh = read_mesh(path("a.stl"));
  ASSERT_FALSE(mesh.ok());
  EXPECT_NE(mesh.error().text.find("a.stl: is a pipe"), std::string::npos) << mesh.error().text;
  std::filesystem::create_directory(path("b.stl"));
  const auto other = read_mesh(path("b.stl"));
  ASSERT_FALSE(other.ok());
  EXPECT_NE(other.error().text.find("b.stl: is a folder"), std::string::npos);
}

// What a reader answers is checked (naughty/naughty_reader.cpp).
TEST_F(ReadMesh, AReaderThatLiesIsASentence) {
  ::setenv("BURR_READ", (test::build_dir() + "/naughty_reader").c_str(), 1);
  EXPECT_EQ(why("a.stl", "behave"), "(a mesh)");
  EXPECT_NE(why("a.stl", "crash").find("a.stl: reading it crashed"), std::string::npos);
  for (const char* how : {"lie_loan", "lie_corner", "lie_nan", "lie_none"})
    EXPECT_NE(why("a.stl", how).find("the reader sent an invalid answer"), std::string::npos)
        << how;
  if (fence_state().landlock > 0) {
    EXPECT_NE(why("a.stl", "open /etc/passwd").find("refused"), std::string::npos);
  }
  if (fence_state().memory_limit) {
    EXPECT_NE(why("a.stl", "eat").find("needs more memory than allowed; simplify it"),
              std::string::npos);
  }
  ::unsetenv("BURR_READ");
}

}  // namespace
}  // namespace burr::io
