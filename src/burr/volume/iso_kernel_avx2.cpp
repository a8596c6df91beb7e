#define BURR_KERNEL avx2
#include "burr/volume/iso_kernel.inc"
