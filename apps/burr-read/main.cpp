// burr-read - reads one scan for burr and nothing else: the process behind the fence (io/fence.h).
#include "burr/io/fence_child.h"
#include "burr/io/readers.h"

int main() { return burr::io::answer_one_request(burr::io::read_unfenced); }
