#define BURR_KERNEL scalar
#include "burr/haptics/six/row_kernel.inc"
