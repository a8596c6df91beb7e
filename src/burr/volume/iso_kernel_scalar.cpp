#define BURR_KERNEL scalar
#include "burr/volume/iso_kernel.inc"
