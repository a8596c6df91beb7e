#define BURR_KERNEL avx512
#include "burr/edit/carve_kernel.inc"
