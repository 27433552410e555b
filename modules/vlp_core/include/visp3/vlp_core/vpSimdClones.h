/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSimdClones_h
#define vpSimdClones_h

/*!
  Before a function with loops that the compiler vectorises: it is compiled for several instruction sets, of
  which the program takes the best that the processor has when it starts (GCC's target_clones). None of them
  contracts products and sums, so that all give the same bits. Elsewhere than on x86-64 it is empty; there
  the processor's vectors are in any program. So it is with ThreadSanitizer: the choice is made while the
  program is loaded, before that is ready.
*/
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(VLP_NO_SIMD_CLONES) &&       \
    !defined(__SANITIZE_THREAD__)
#define VP_SIMD_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define VP_SIMD_CLONES
#endif

#endif
