#define BURR_KERNEL avx512
#include "burr/volume/iso_kernel.inc"
