#define BURR_KERNEL scalar
#include "burr/importing/smooth_kernel.inc"
