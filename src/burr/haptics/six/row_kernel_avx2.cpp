#define BURR_KERNEL avx2
#include "burr/haptics/six/row_kernel.inc"
