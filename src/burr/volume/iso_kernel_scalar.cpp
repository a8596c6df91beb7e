#define BURR_KERNEL scalar
#include "burr/volume/iso_kernel_impl.h"
