// Big uninitialised arrays that searches use one after the other: fresh pages cost more than what fills them.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace stairwright::lattice {

inline constexpr std::size_t kKeptBytes = 64'000'000;  // of an array that is kept for the next one of its thread

struct Free {
    void operator()(void* p) const { std::free(p); }
};

// Uninitialised memory, in huge pages where the system has them: sweeps jump between volumes.
template <typename T>
std::unique_ptr<T[], Free> huge_array(std::size_t count) {
    constexpr std::size_t page = std::size_t{1} << 21;
    const std::size_t bytes = count * sizeof(T), whole = (bytes + page - 1) / page * page;
    void* p = bytes < page ? std::malloc(bytes > 0 ? bytes : 1) : std::aligned_alloc(page, whole);
    if (p == nullptr) throw std::bad_alloc();
#if defined(__linux__)
    if (bytes >= page) ::madvise(p, whole, MADV_HUGEPAGE);
#endif
    return std::unique_ptr<T[], Free>(static_cast<T*>(p));
}

template <typename T>
class Reused {
public:
    explicit Reused(std::size_t size) : size_(size) {
        Spare& spare = of_thread();
        if (spare.size >= size)
            std::swap(spare, own_);
        else
            own_ = {huge_array<T>(size), size};
    }
    ~Reused() {
        Spare& spare = of_thread();
        if (own_.size * sizeof(T) <= kKeptBytes && own_.size > spare.size) std::swap(spare, own_);
    }
    Reused(const Reused&) = delete;
    Reused& operator=(const Reused&) = delete;

    T* data() { return own_.data.get(); }
    const T* data() const { return own_.data.get(); }
    std::size_t size() const { return size_; }

private:
    struct Spare {
        std::unique_ptr<T[], Free> data;
        std::size_t size = 0;
    };
    static Spare& of_thread() {
        thread_local Spare spare;
        return spare;
    }

    Spare own_;
    std::size_t size_ = 0;
};

}  // namespace stairwright::lattice
