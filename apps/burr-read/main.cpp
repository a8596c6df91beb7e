// burr-read - reads one scan or one mesh for burr and does nothing else: the process behind the fence
// (io/sandbox/fence.h).
#include "burr/io/read/mesh_readers.h"
#include "burr/io/read/readers.h"
#include "burr/io/sandbox/fence_child.h"

int main() {
  return burr::io::answer_one_request(burr::io::read_unfenced, burr::io::read_mesh_unfenced);
}
