// burr_vtk_oracle SIZE RUNS - an independent comparison for `burr bench surface`: vtkFlyingEdges3D
// with normals on the same field. Prints: median ms on 1 thread, on 2 threads, triangles. C++17:
// VTK 9.1 does not compile as C++20.
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>
#include <vtkUnsignedShortArray.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "apps/burr/bench/bench_shell.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const int size = std::atoi(argv[1]), runs = std::atoi(argv[2]);
  if (size < 2 || runs < 1) return 2;
  std::vector<std::uint16_t> field = burr::bench::shell_field(size);

  vtkNew<vtkUnsignedShortArray> scalars;
  scalars->SetArray(field.data(), static_cast<vtkIdType>(field.size()), 1);
  vtkNew<vtkImageData> image;
  image->SetDimensions(size, size, size);
  image->SetSpacing(0.5e-3, 0.5e-3, 0.5e-3);
  image->GetPointData()->SetScalars(scalars);

  long long triangles = 0;
  for (int threads = 1; threads <= 2; ++threads) {
    vtkSMPTools::Initialize(threads);
    std::vector<double> took;
    for (int run = 0; run < runs; ++run) {
      vtkNew<vtkFlyingEdges3D> edges;
      edges->SetInputData(image);
      edges->SetValue(0, 32768);
      edges->ComputeNormalsOn();
      edges->ComputeGradientsOff();
      edges->ComputeScalarsOff();
      const auto start = std::chrono::steady_clock::now();
      edges->Update();
      took.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
              .count());
      triangles = edges->GetOutput()->GetNumberOfPolys();
    }
    std::sort(took.begin(), took.end());
    std::printf("%.3f ", took[took.size() / 2]);
  }
  std::printf("%lld\n", triangles);
  return 0;
}
