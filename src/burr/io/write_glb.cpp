// GLB (glTF 2.0) through assimp: metres, +Y up; the only file that knows assimp.
#include <assimp/config.h>
#include <assimp/scene.h>

#include <assimp/Exporter.hpp>
#include <cmath>
#include <memory>

#include "burr/io/mesh_formats.h"

namespace burr::io {
namespace {

// glTF colours of vertices are linear (glTF 2.0, 3.7.2.1)
float linear(float srgb) {
  return srgb <= 0.04045F ? srgb / 12.92F : std::pow((srgb + 0.055F) / 1.055F, 2.4F);
}

// left, superior, anterior: a rotation, so that the head stands upright and looks at the viewer
aiVector3D upright(const math::Vec3f& lps) { return {lps.x(), lps.z(), -lps.y()}; }

bool fill(const MeshOut& out, aiMesh& mesh, Progress& progress) {
  const auto vertices = static_cast<unsigned>(out.p_mm.size());
  const auto triangles = static_cast<unsigned>(out.mesh.triangles.size() / 3);
  mesh.mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  mesh.mNumVertices = vertices;
  mesh.mVertices = new aiVector3D[vertices];
  mesh.mNormals = new aiVector3D[vertices];
  mesh.mColors[0] = new aiColor4D[vertices];
  for (unsigned v = 0; v < vertices; ++v) {
    if (!go_on(progress, v, vertices + triangles)) return false;
    const surface::Vertex& vertex = out.mesh.vertices[v];
    const auto& colour = out.tissues[vertex.tissue].colour;
    mesh.mVertices[v] = upright(vertex.p);  // metres already
    mesh.mNormals[v] = upright(vertex.n);
    mesh.mColors[0][v] = {linear(colour[0]), linear(colour[1]), linear(colour[2]), 1};
  }
  mesh.mNumFaces = triangles;
  mesh.mFaces = new aiFace[triangles];
  for (unsigned t = 0; t < triangles; ++t) {
    if (!go_on(progress, t, triangles)) return false;
    aiFace& face = mesh.mFaces[t];
    face.mNumIndices = 3;
    face.mIndices = new unsigned[3];
    for (unsigned c = 0; c < 3; ++c) face.mIndices[c] = out.mesh.triangles[3 * t + c];
  }
  return true;
}

}  // namespace

Status write_glb(const MeshOut& out, base::NewFile& file, const std::string& path,
                 Progress& progress) {
  if (out.mesh.triangles.size() > 0x3FFFFFFFULL)
    return error(path + ": the mesh is too large for GLB (4 GB); use .ply, or a larger --voxel-mm");
  aiScene scene;  // frees what hangs on it
  scene.mRootNode = new aiNode("bone");
  scene.mNumMaterials = 1;
  scene.mMaterials = new aiMaterial* [1] { new aiMaterial };
  const aiString name("bone");
  scene.mMaterials[0]->AddProperty(&name, AI_MATKEY_NAME);
  const aiColor4D white(1, 1, 1, 1);
  scene.mMaterials[0]->AddProperty(&white, 1, AI_MATKEY_BASE_COLOR);
  const float metal = 0, rough = 0.8F;
  scene.mMaterials[0]->AddProperty(&metal, 1, AI_MATKEY_METALLIC_FACTOR);
  scene.mMaterials[0]->AddProperty(&rough, 1, AI_MATKEY_ROUGHNESS_FACTOR);
  scene.mNumMeshes = 1;
  scene.mMeshes = new aiMesh* [1] { new aiMesh };
  scene.mMeshes[0]->mMaterialIndex = 0;
  scene.mMeshes[0]->mName = name;
  scene.mRootNode->mNumMeshes = 1;
  scene.mRootNode->mMeshes = new unsigned[1]{0};
  if (!fill(out, *scene.mMeshes[0], progress)) return stopped_writing(path);

  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(&scene, "glb2", 0);
  if (blob == nullptr)
    return error(Trouble::internal,
                 path + ": assimp could not make a GLB: " + std::string(exporter.GetErrorString()));
  file.write(blob->data, blob->size);
  return fine();
}

}  // namespace burr::io
