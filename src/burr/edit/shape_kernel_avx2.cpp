#define BURR_KERNEL avx2
#include "burr/edit/shape_kernel.inc"
