#define BURR_KERNEL avx2
#include "burr/edit/carve_kernel.inc"
