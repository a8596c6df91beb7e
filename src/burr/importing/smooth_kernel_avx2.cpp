#define BURR_KERNEL avx2
#include "burr/importing/smooth_kernel.inc"
