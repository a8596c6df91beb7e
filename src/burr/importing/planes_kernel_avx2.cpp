#define BURR_KERNEL avx2
#include "burr/importing/planes_kernel.inc"
