#define BURR_KERNEL avx2
#include "rt/lanes_checks.inc"
