#pragma once
// OpenBLAS asks the system for buffers of 128 MB when it is first used, one for each of two threads here, and asks again and
// again, for ever, where it gets none.

namespace palpa::mechanics {

// Throws OutOfMemory if the system would not give these buffers. To be called before OpenBLAS is used; costs nothing from the
// second time on.
void require_blas_memory();

}  // namespace palpa::mechanics
