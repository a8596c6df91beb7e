#define BURR_KERNEL scalar
#include "burr/edit/shape_kernel.inc"
