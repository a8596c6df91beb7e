#define BURR_KERNEL avx2
#include "burr/io/planes_kernel.inc"
