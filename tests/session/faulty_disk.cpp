#include "tests/session/faulty_disk.hpp"

#include <signal.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cstdlib>

namespace bolt::session::test {

namespace {

struct Faults {
    DiskFault fault = DiskFault::none;
    int at = 0;
    int done = 0;
    bool installed = false;
};
Faults faults;
sqlite3_vfs* real_disk = nullptr;

struct File {
    sqlite3_file base;
    sqlite3_file* real;  // its memory follows this struct
};

sqlite3_file* real_of(sqlite3_file* file) { return reinterpret_cast<File*>(file)->real; }

bool is_due() { return ++faults.done > faults.at; }

[[noreturn]] void die() {
    ::kill(::getpid(), SIGKILL);
    std::abort();
}

// For operations that need no space on the disk.
void count_or_die() {
    if (is_due() && faults.fault == DiskFault::kill) die();
}

int close(sqlite3_file* file) { return real_of(file)->pMethods->xClose(real_of(file)); }
int read(sqlite3_file* file, void* to, int size, sqlite3_int64 at) {
    return real_of(file)->pMethods->xRead(real_of(file), to, size, at);
}
int write(sqlite3_file* file, const void* from, int size, sqlite3_int64 at) {
    sqlite3_file* const real = real_of(file);
    if (is_due() && faults.fault == DiskFault::full) return SQLITE_FULL;
    if (faults.done > faults.at && faults.fault == DiskFault::kill) {
        real->pMethods->xWrite(real, from, size / 2, at);
        die();
    }
    return real->pMethods->xWrite(real, from, size, at);
}
int truncate(sqlite3_file* file, sqlite3_int64 size) {
    count_or_die();
    return real_of(file)->pMethods->xTruncate(real_of(file), size);
}
int sync(sqlite3_file* file, int flags) {
    count_or_die();
    return real_of(file)->pMethods->xSync(real_of(file), flags);
}
int size_of(sqlite3_file* file, sqlite3_int64* size) {
    return real_of(file)->pMethods->xFileSize(real_of(file), size);
}
int lock(sqlite3_file* file, int level) { return real_of(file)->pMethods->xLock(real_of(file), level); }
int unlock(sqlite3_file* file, int level) { return real_of(file)->pMethods->xUnlock(real_of(file), level); }
int is_reserved(sqlite3_file* file, int* out) {
    return real_of(file)->pMethods->xCheckReservedLock(real_of(file), out);
}
int control(sqlite3_file* file, int code, void* value) {
    return real_of(file)->pMethods->xFileControl(real_of(file), code, value);
}
int sector_size(sqlite3_file* file) { return real_of(file)->pMethods->xSectorSize(real_of(file)); }
int traits(sqlite3_file* file) { return real_of(file)->pMethods->xDeviceCharacteristics(real_of(file)); }
int map_shared(sqlite3_file* file, int page, int size, int extend, void volatile** out) {
    return real_of(file)->pMethods->xShmMap(real_of(file), page, size, extend, out);
}
int lock_shared(sqlite3_file* file, int offset, int count, int flags) {
    return real_of(file)->pMethods->xShmLock(real_of(file), offset, count, flags);
}
void shared_barrier(sqlite3_file* file) { real_of(file)->pMethods->xShmBarrier(real_of(file)); }
int unmap_shared(sqlite3_file* file, int remove) {
    return real_of(file)->pMethods->xShmUnmap(real_of(file), remove);
}

constexpr sqlite3_io_methods methods = {
    2,           close,          read,         write,   truncate,    sync,   size_of,
    lock,        unlock,         is_reserved,  control, sector_size, traits, map_shared,
    lock_shared, shared_barrier, unmap_shared, nullptr, nullptr,
};

int open(sqlite3_vfs* /*disk*/, const char* name, sqlite3_file* out, int flags, int* flags_out) {
    auto* const file = reinterpret_cast<File*>(out);
    file->real = reinterpret_cast<sqlite3_file*>(file + 1);
    file->base.pMethods = nullptr;
    const int code = real_disk->xOpen(real_disk, name, file->real, flags, flags_out);
    if (file->real->pMethods != nullptr) file->base.pMethods = &methods;
    return code;
}

int remove(sqlite3_vfs* /*disk*/, const char* name, int sync_folder) {
    count_or_die();
    return real_disk->xDelete(real_disk, name, sync_folder);
}

sqlite3_vfs faulty_disk;

}  // namespace

FaultyDisk::FaultyDisk(DiskFault fault, int at_operation) {
    if (faults.installed) std::abort();
    faults = {fault, at_operation, 0, true};
    real_disk = sqlite3_vfs_find(nullptr);
    faulty_disk = *real_disk;
    faulty_disk.zName = "faulty";
    faulty_disk.szOsFile += static_cast<int>(sizeof(File));
    faulty_disk.xOpen = open;
    faulty_disk.xDelete = remove;
    sqlite3_vfs_register(&faulty_disk, 1);
}

FaultyDisk::~FaultyDisk() {
    sqlite3_vfs_unregister(&faulty_disk);
    sqlite3_vfs_register(real_disk, 1);
    faults.installed = false;
}

int FaultyDisk::operations() { return faults.done; }

}  // namespace bolt::session::test
