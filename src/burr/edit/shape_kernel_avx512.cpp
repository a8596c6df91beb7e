#define BURR_KERNEL avx512
#include "burr/edit/shape_kernel.inc"
