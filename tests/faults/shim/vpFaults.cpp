/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
/*!
  \file vpFaults.cpp
  For LD_PRELOAD: makes system calls of a program fail or come short, or its memory end. Environment:

  - VLP_FAULT_CALL: open, read, write, close, rename, mkdir or fsync; or memory: blocks of 32 KiB or more
    that a program asks for once it has opened a file under that path. The system always has small ones.
  - VLP_FAULT_UNDER: what their paths begin with, as a folder, `/dev/pts/` or `socket:`
  - VLP_FAULT_AS: ENOSPC, EIO or EINTR, for errno; or short: half of the bytes are read or written
  - VLP_FAULT_AT: which of these calls, `3` the third, `3+` it and all after it, `odd` the first, third, fifth
  ...
  - VLP_FAULT_HIT: a file that is made as soon as one was hit

  A file that cannot be closed is closed nevertheless, as the system does it. Calls between the functions of
  the C library itself are not seen: fopen() and fclose() are looked at instead.
*/
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

namespace
{
//! The function that would be called without this library.
template <typename F>
F *next(const char *name)
{
  return reinterpret_cast<F *>(dlsym(RTLD_NEXT, name));
}

const char *variable(const char *name)
{
  const char *value = getenv(name);
  return value != nullptr ? value : "";
}

bool under(const char *path)
{
  const char *prefix = variable("VLP_FAULT_UNDER");
  return *prefix != '\0' && path != nullptr && strncmp(path, prefix, strlen(prefix)) == 0;
}

bool under(int file)
{
  char link[64], path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  path[length > 0 ? length : 0] = '\0';
  return length > 0 && under(path);
}

bool isShort()
{
  return strcmp(variable("VLP_FAULT_AS"), "short") == 0;
}

//! Counts a call on that path or file. \return Whether it is one to be hit.
template <typename Place>
bool hit(const char *call, Place place)
{
  static std::atomic<long> count{0};
  if (strcmp(variable("VLP_FAULT_CALL"), call) != 0) {
    return false;
  }
  const int error = errno;
  if (!under(place)) {
    errno = error;
    return false;
  }
  const long number = ++count;
  const char *at = variable("VLP_FAULT_AT");
  char *end = nullptr;
  const long wanted = strtol(at, &end, 10);
  const bool hits =
      strcmp(at, "odd") == 0 ? number % 2 == 1 : number == wanted || (*end == '+' && number > wanted);
  if (hits) {
    syscall(SYS_close, syscall(SYS_openat, AT_FDCWD, variable("VLP_FAULT_HIT"), O_CREAT | O_WRONLY, 0600));
  }
  errno = error;
  return hits;
}

//! Sets errno. \return -1, for the caller to return.
int failure()
{
  const char *name = variable("VLP_FAULT_AS");
  errno = strcmp(name, "ENOSPC") == 0 ? ENOSPC : strcmp(name, "EINTR") == 0 ? EINTR : EIO;
  return -1;
}

std::atomic<bool> begun{false}; // a file was opened

int openWith(const char *name, const char *path, int flags, mode_t mode)
{
  begun = begun || under(path);
  return hit("open", path) ? failure() : next<int(const char *, int, ...)>(name)(path, flags, mode);
}

FILE *fopenWith(const char *name, const char *path, const char *mode)
{
  begun = begun || under(path);
  if (hit("open", path)) {
    failure();
    return nullptr;
  }
  return next<FILE *(const char *, const char *)>(name)(path, mode);
}

void *outOfMemory()
{
  errno = ENOMEM;
  return nullptr;
}

//! Whether there is no such block left.
bool used(size_t bytes)
{
  constexpr size_t large = 1 << 15;
  return bytes >= large && begun && hit("memory", variable("VLP_FAULT_UNDER"));
}

//! Of \e length bytes, how many to ask for.
size_t half(size_t length)
{
  return length > 1 ? length / 2 : length;
}
} // namespace

extern "C" {
// Those of the C library, by the names that only it has.
void *__libc_malloc(size_t bytes);
void *__libc_calloc(size_t count, size_t bytes);
void *__libc_realloc(void *before, size_t bytes);
void *__libc_memalign(size_t alignment, size_t bytes);

void *malloc(size_t bytes)
{
  return used(bytes) ? outOfMemory() : __libc_malloc(bytes);
}

void *calloc(size_t count, size_t bytes)
{
  return used(count * bytes) ? outOfMemory() : __libc_calloc(count, bytes);
}

void *realloc(void *before, size_t bytes)
{
  return used(bytes) ? outOfMemory() : __libc_realloc(before, bytes);
}

int posix_memalign(void **memory, size_t alignment, size_t bytes)
{
  *memory = used(bytes) ? outOfMemory() : __libc_memalign(alignment, bytes);
  return *memory != nullptr ? 0 : ENOMEM;
}

int open(const char *path, int flags, ...)
{
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  return openWith("open", path, flags, mode);
}

int open64(const char *path, int flags, ...)
{
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  return openWith("open64", path, flags, mode);
}

FILE *fopen(const char *path, const char *mode)
{
  return fopenWith("fopen", path, mode);
}

FILE *fopen64(const char *path, const char *mode)
{
  return fopenWith("fopen64", path, mode);
}

ssize_t read(int file, void *bytes, size_t length)
{
  const bool hits = hit("read", file);
  if (hits && !isShort()) {
    return failure();
  }
  return next<ssize_t(int, void *, size_t)>("read")(file, bytes, hits ? half(length) : length);
}

ssize_t write(int file, const void *bytes, size_t length)
{
  const bool hits = hit("write", file);
  if (hits && !isShort()) {
    return failure();
  }
  return next<ssize_t(int, const void *, size_t)>("write")(file, bytes, hits ? half(length) : length);
}

ssize_t writev(int file, const iovec *parts, int count)
{
  if (hit("write", file)) {
    return isShort() ? syscall(SYS_write, file, parts[0].iov_base, half(parts[0].iov_len)) : failure();
  }
  return next<ssize_t(int, const iovec *, int)>("writev")(file, parts, count);
}

int close(int file)
{
  const bool hits = hit("close", file);
  const int result = next<int(int)>("close")(file);
  return hits ? failure() : result;
}

int fclose(FILE *file)
{
  const bool hits = hit("close", fileno(file));
  const int result = next<int(FILE *)>("fclose")(file);
  return hits ? failure() : result;
}

int rename(const char *from, const char *to)
{
  return hit("rename", to) ? failure() : next<int(const char *, const char *)>("rename")(from, to);
}

int mkdir(const char *path, mode_t mode)
{
  return hit("mkdir", path) ? failure() : next<int(const char *, mode_t)>("mkdir")(path, mode);
}

int fsync(int file)
{
  return hit("fsync", file) ? failure() : next<int(int)>("fsync")(file);
}
}
