#define BURR_KERNEL scalar
#include "burr/importing/planes_kernel.inc"
