// burr_vtk_frame FILE WIDTH HEIGHT FRAMES - how fast VTK draws the same triangles from the same eye
// point while they rotate, for `burr bench frame`. Prints the median time per frame [ms]. C++17:
// VTK 9.1 does not compile as C++20. Needs a display (DISPLAY): Debian's VTK draws through X.
//
// FILE, in this machine's number format: double eye[3], target[3], up[3], angle [deg];
// uint32 vertices, triangles; float p[3], n[3] per vertex; uint32 corner[3] per triangle.
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

template <class T>
bool take(std::FILE* file, T* to, std::size_t count) {
  return std::fread(to, sizeof(T), count, file) == count;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5 || std::getenv("DISPLAY") == nullptr) return 2;
  const int width = std::atoi(argv[2]), height = std::atoi(argv[3]), frames = std::atoi(argv[4]);
  if (width < 1 || height < 1 || frames < 1) return 2;
  std::FILE* file = std::fopen(argv[1], "rb");
  if (file == nullptr) return 3;
  double eye[10] = {};
  std::uint32_t count[2] = {};
  if (!take(file, eye, 10) || !take(file, count, 2)) return 3;
  vtkNew<vtkFloatArray> places, normals;
  for (vtkFloatArray* array : {places.Get(), normals.Get()}) {
    array->SetNumberOfComponents(3);
    array->SetNumberOfTuples(static_cast<vtkIdType>(count[0]));
  }
  for (std::uint32_t v = 0; v < count[0]; ++v) {
    float values[6];
    if (!take(file, values, 6)) return 3;
    places->SetTypedTuple(static_cast<vtkIdType>(v), values);
    normals->SetTypedTuple(static_cast<vtkIdType>(v), values + 3);
  }
  vtkNew<vtkCellArray> triangles;
  for (std::uint32_t t = 0; t < count[1]; ++t) {
    std::uint32_t corner[3];
    if (!take(file, corner, 3)) return 3;
    const vtkIdType ids[3] = {static_cast<vtkIdType>(corner[0]), static_cast<vtkIdType>(corner[1]),
                              static_cast<vtkIdType>(corner[2])};
    triangles->InsertNextCell(3, ids);
  }
  std::fclose(file);

  vtkNew<vtkPoints> points;
  points->SetData(places);
  vtkNew<vtkPolyData> mesh;
  mesh->SetPoints(points);
  mesh->SetPolys(triangles);
  mesh->GetPointData()->SetNormals(normals);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(mesh);
  vtkNew<vtkActor> bone;
  bone->SetMapper(mapper);
  bone->GetProperty()->SetColor(0.9, 0.85, 0.75);
  bone->GetProperty()->BackfaceCullingOn();  // said to be VTK's largest gain
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(bone);
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->SetPosition(eye);
  camera->SetFocalPoint(eye + 3);
  camera->SetViewUp(eye + 6);
  camera->SetViewAngle(eye[9]);
  renderer->ResetCameraClippingRange();
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(width, height);
  window->AddRenderer(renderer);
  window->Render();  // sends the triangles
  window->WaitForCompletion();

  std::vector<double> took;
  for (int n = 0; n < frames; ++n) {
    camera->Azimuth(0.5);
    renderer->ResetCameraClippingRange();
    const auto start = std::chrono::steady_clock::now();
    window->Render();
    window->WaitForCompletion();
    took.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
            .count());
  }
  std::sort(took.begin(), took.end());
  std::printf("%.3f\n", took[took.size() / 2]);
  return 0;
}
