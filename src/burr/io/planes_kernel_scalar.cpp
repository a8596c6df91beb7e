#define BURR_KERNEL scalar
#include "burr/io/planes_kernel.inc"
