// A library to preload: the n-th call of a kind, counted from main on, fails as if the system had no more
// resources, or the process is killed there.
//
//   PRT_FAULT=KIND:N[:all|:kill]  KIND is write, open, rename, sync, map, allocate or thread; N starts at 1.
//                                 all: later calls also fail.
//   PRT_FAULT_COUNTS=FILE         writes the number of calls of each kind: "write 12\n" ...
//   PRT_FAULT_WITHOUT=WHAT        features that the file system does not support: tmpfile (O_TMPFILE),
//                                 exchange (renameat2), or both
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

enum Kind { kWrite, kOpen, kRename, kSync, kMap, kAllocate, kThread, kKinds };
static const char* const kNames[kKinds] = {"write", "open", "rename", "sync", "map", "allocate", "thread"};
static const int kErrors[kKinds] = {ENOSPC, EMFILE, EIO, EIO, ENOMEM, ENOMEM, EAGAIN};

static atomic_int armed;
static atomic_long counts[kKinds];
static int fault_kind = kKinds, fault_all, fault_kill, no_tmpfile, no_exchange;
static long fault_at;
static const char* counts_file;

/// Returns true if this call must fail; sets errno.
static int fails(enum Kind kind) {
    if (!atomic_load(&armed))
        return 0;
    const long n = atomic_fetch_add(&counts[kind], 1) + 1;
    if ((int)kind != fault_kind || (fault_all ? n < fault_at : n != fault_at))
        return 0;
    if (fault_kill)
        syscall(SYS_kill, getpid(), SIGKILL);
    errno = kErrors[kind];
    return 1;
}

#define REAL(name) (__extension__(__typeof__(&name)) dlsym(RTLD_NEXT, #name))

ssize_t write(int file, const void* bytes, size_t size) {
    return file > 2 && fails(kWrite) ? -1 : syscall(SYS_write, file, bytes, size);
}
ssize_t writev(int file, const struct iovec* parts, int count) {
    return file > 2 && fails(kWrite) ? -1 : syscall(SYS_writev, file, parts, count);
}

static int opened(int folder, const char* path, int flags, mode_t mode) {
    if ((flags & O_TMPFILE) == O_TMPFILE && no_tmpfile) {
        errno = EOPNOTSUPP;
        return -1;
    }
    return fails(kOpen) ? -1 : (int)syscall(SYS_openat, folder, path, flags, mode);
}
static mode_t mode_of(int flags, va_list* rest) {
    return flags & (O_CREAT | O_TMPFILE) ? va_arg(*rest, mode_t) : 0;
}
#define OPEN(name)                                                                                           \
    int name(const char* path, int flags, ...) {                                                             \
        va_list rest;                                                                                        \
        va_start(rest, flags);                                                                               \
        const mode_t mode = mode_of(flags, &rest);                                                           \
        va_end(rest);                                                                                        \
        return opened(AT_FDCWD, path, flags, mode);                                                          \
    }
OPEN(open)
OPEN(open64)
FILE* fopen(const char* path, const char* mode) {
    return fails(kOpen) ? NULL : REAL(fopen)(path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
    return fails(kOpen) ? NULL : REAL(fopen64)(path, mode);
}

int rename(const char* from, const char* to) {
    return fails(kRename) ? -1 : (int)syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
}
int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
    if (no_exchange) {
        errno = EINVAL;
        return -1;
    }
    return fails(kRename) ? -1 : (int)syscall(SYS_renameat2, from_folder, from, to_folder, to, flags);
}
int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) {
    return fails(kRename) ? -1 : (int)syscall(SYS_linkat, from_folder, from, to_folder, to, flags);
}
int fsync(int file) {
    return fails(kSync) ? -1 : (int)syscall(SYS_fsync, file);
}

static void* mapped(void* at, size_t size, int protection, int flags, int file, off_t offset) {
    return fails(kMap) ? MAP_FAILED : (void*)syscall(SYS_mmap, at, size, protection, flags, file, offset);
}
void* mmap(void* at, size_t size, int protection, int flags, int file, off_t offset) {
    return mapped(at, size, protection, flags, file, offset);
}
void* mmap64(void* at, size_t size, int protection, int flags, int file, off_t offset) {
    return mapped(at, size, protection, flags, file, offset);
}

extern void* __libc_malloc(size_t);
extern void* __libc_calloc(size_t, size_t);
extern void* __libc_realloc(void*, size_t);
extern void* __libc_memalign(size_t, size_t);
void* malloc(size_t size) {
    return fails(kAllocate) ? NULL : __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
    return fails(kAllocate) ? NULL : __libc_calloc(count, size);
}
void* realloc(void* old, size_t size) {
    return fails(kAllocate) ? NULL : __libc_realloc(old, size);
}
void* aligned_alloc(size_t alignment, size_t size) {
    return fails(kAllocate) ? NULL : __libc_memalign(alignment, size);
}
int posix_memalign(void** result, size_t alignment, size_t size) {
    if (fails(kAllocate))
        return ENOMEM;
    *result = __libc_memalign(alignment, size);
    return *result ? 0 : ENOMEM;
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*body)(void*),
                   void* argument) {
    return fails(kThread) ? EAGAIN : REAL(pthread_create)(thread, attributes, body, argument);
}

static void read_environment(void) {
    const char* fault = getenv("PRT_FAULT");
    const char* number = fault ? strchr(fault, ':') : NULL;
    for (int kind = 0; number && kind < kKinds; ++kind)
        if (strncmp(fault, kNames[kind], (size_t)(number - fault)) == 0)
            fault_kind = kind;
    if (number) {
        fault_at = atol(number + 1);
        fault_all = strstr(number, ":all") != NULL;
        fault_kill = strstr(number, ":kill") != NULL;
    }
    const char* without = getenv("PRT_FAULT_WITHOUT");
    no_tmpfile = without && strstr(without, "tmpfile");
    no_exchange = without && strstr(without, "exchange");
    counts_file = getenv("PRT_FAULT_COUNTS");
}

static void write_counts(void) {
    atomic_store(&armed, 0);
    const int file = counts_file ? open(counts_file, O_WRONLY | O_CREAT | O_TRUNC, 0666) : -1;
    for (int kind = 0; file >= 0 && kind < kKinds; ++kind)
        dprintf(file, "%s %ld\n", kNames[kind], atomic_load(&counts[kind]));
    if (file >= 0)
        close(file);
}

typedef int (*Main)(int, char**, char**);
static Main program;
static int armed_main(int count, char** words, char** environment) {
    atomic_store(&armed, 1);
    const int status = program(count, words, environment);
    write_counts();
    return status;
}

/// Faults start with main: loading of libraries is not tested.
int __libc_start_main(Main main, int count, char** words, void (*init)(void), void (*fini)(void),
                      void (*at_exit)(void), void* stack) {
    read_environment();
    program = main;
    int (*start)(Main, int, char**, void (*)(void), void (*)(void), void (*)(void), void*) =
        __extension__(__typeof__(start)) dlsym(RTLD_NEXT, "__libc_start_main");
    return start(armed_main, count, words, init, fini, at_exit, stack);
}
