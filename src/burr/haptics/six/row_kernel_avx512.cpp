#define BURR_KERNEL avx512
#include "burr/haptics/six/row_kernel.inc"
