#define BURR_KERNEL scalar
#include "burr/edit/carve_kernel.inc"
