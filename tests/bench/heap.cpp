/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Heap from frame to pose: allocations per frame, and the most that is held beside the frames themselves.
// bench_heap [--check]: a Markdown table; --check fails where more than 1.5 frames + 16 MiB are held, or
// where a tracked frame allocates anything; from the top of the repository

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <malloc.h>

#include <opencv2/core/utility.hpp>
#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include "vpSpeedScene.h"

namespace
{
struct Heap {
  size_t allocations = 0, held = 0, most = 0; // most, held: bytes
  void take(void *block)
  {
    ++allocations;
    held += block != nullptr ? malloc_usable_size(block) : 0;
    most = std::max(most, held);
  }
  void giveBack(void *block) { held -= block != nullptr ? malloc_usable_size(block) : 0; }
};
Heap heap; // of this thread, which is the only one
} // namespace

// glibc's own, by the names that it keeps for such purposes.
extern "C" {
void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);
void __libc_free(void *);

void *malloc(size_t size)
{
  void *block = __libc_malloc(size);
  heap.take(block);
  return block;
}

void *calloc(size_t count, size_t size)
{
  void *block = __libc_calloc(count, size);
  heap.take(block);
  return block;
}

void *realloc(void *before, size_t size)
{
  heap.giveBack(before);
  void *block = __libc_realloc(before, size);
  heap.take(block);
  return block;
}

void *memalign(size_t alignment, size_t size)
{
  void *block = __libc_memalign(alignment, size);
  heap.take(block);
  return block;
}

void *aligned_alloc(size_t alignment, size_t size)
{
  return memalign(alignment, size);
}

int posix_memalign(void **block, size_t alignment, size_t size)
{
  *block = memalign(alignment, size);
  return *block != nullptr ? 0 : 12; // ENOMEM
}

void free(void *block)
{
  heap.giveBack(block);
  __libc_free(block);
}
}

namespace
{
struct Use {
  double allocations = 0; // per frame, mean
  double most = 0;        // bytes held at once beyond what was held before the localizer was
};

Use useOf(const vpSpeedCase &what, bool tracking, int frames)
{
  static const int warmUp = 6; // frames after which all lamps are followed
  const vpSpeedScene scene(what);
  std::vector<vpVlpFrame> all;
  for (int k = 0; k < warmUp + frames; ++k) {
    all.push_back(tracking ? scene.loopFrame(k) : scene.stillFrame(k));
  }
  const size_t before = heap.held;
  heap.most = before;
  vpVlpLocalizer localizer(scene.rig(), scene.map());
  localizer.tracking = tracking;
  vpVlpLocation location;
  for (int k = 0; k < warmUp; ++k) {
    localizer.process(all[static_cast<size_t>(k)], location);
  }
  // Of the median frame: those in which the estimator compares rig and map with less exact ones take some.
  std::vector<size_t> allocations;
  allocations.reserve(static_cast<size_t>(frames));
  for (int k = warmUp; k < warmUp + frames; ++k) {
    heap.allocations = 0;
    localizer.process(all[static_cast<size_t>(k)], location);
    allocations.push_back(heap.allocations);
  }
  std::sort(allocations.begin(), allocations.end());
  return {static_cast<double>(allocations[allocations.size() / 2]), static_cast<double>(heap.most - before)};
}
} // namespace

int main(int argc, char **argv)
{
  const bool check = argc > 1 && std::strcmp(argv[1], "--check") == 0;
  cv::setNumThreads(1);
  static const double mebi = 1024 * 1024;
  bool good = true;
  std::printf("| frames | allocations of the median frame, whole | tracked | most held, MiB, whole | tracked "
              "| asked |\n"
              "|---|---|---|---|---|---|\n");
  for (const auto &[width, height] : {std::pair(800u, 600u), std::pair(2048u, 1536u)}) {
    vpSpeedCase what;
    what.width = width;
    what.height = height;
    const Use whole = useOf(what, false, 8), tracked = useOf(what, true, 12);
    const double asked = 1.5 * what.pixels() + 16 * mebi;
    std::printf("| %ux%u | %.0f | %.0f | %.2f | %.2f | %.1f |\n", width, height, whole.allocations,
                tracked.allocations, whole.most / mebi, tracked.most / mebi, asked / mebi);
    good = good && whole.most < asked && tracked.most < asked && tracked.allocations == 0;
  }
  return check && !good ? 1 : 0;
}
