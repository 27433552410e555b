/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpAllocatedMemory_h
#define vpAllocatedMemory_h

#include <malloc.h>

//! MiB that are allocated; 0 under a sanitizer, which has a heap of its own and finds leaks itself.
inline double vpAllocatedMemory()
{
  const struct mallinfo2 heap = mallinfo2();
  return static_cast<double>(heap.uordblks + heap.hblkhd) / (1 << 20);
}

#endif
