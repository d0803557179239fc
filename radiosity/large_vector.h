// Vectors of millions of values, in huge pages where the system has them.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

namespace tyndall::radiosity {

// Memory comes in pages, each of which costs a microsecond or more when it is first written to: for
// rows, as much as a product with them takes, and more. Pages of 2 MiB cost as much as those of
// 4 KiB, and there are 512 times fewer.
template <class T>
struct HugePages {
    using value_type = T;  // what the allocator allocates

    HugePages() = default;
    template <class Other>
    HugePages(const HugePages<Other>&) {}

    // Memory for `count` values, none of them made. Errors: std::bad_alloc.
    T* allocate(std::size_t count) {
        if (count > most / sizeof(T)) throw std::bad_alloc();
        const std::size_t bytes = count * sizeof(T);
        const bool large = bytes >= 2 * page;
        void* memory = large ? std::aligned_alloc(page, (bytes + page - 1) / page * page)
                             : std::malloc(bytes > 0 ? bytes : 1);
        if (!memory) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
        // What is not written to is not taken, but for the last page. A system without huge pages
        // says no: nothing is lost.
        if (large) madvise(memory, bytes / page * page, MADV_HUGEPAGE);
#endif
        return static_cast<T*>(memory);
    }
    // Gives it back.
    void deallocate(T* memory, std::size_t) {
        std::free(memory);
    }

    // `resize` leaves numbers as they are, for others to write: memory is gone over once, not
    // twice.
    template <class Element>
    void construct(Element* place) {
        ::new (static_cast<void*>(place)) Element;
    }
    template <class Element, class... Arguments>
    void construct(Element* place, Arguments&&... arguments) {
        ::new (static_cast<void*>(place)) Element(std::forward<Arguments>(arguments)...);
    }

    // One gives back what another has allocated.
    friend bool operator==(HugePages, HugePages) {
        return true;
    }

  private:
    static constexpr std::size_t page = std::size_t(2) << 20;
    static constexpr std::size_t most = static_cast<std::size_t>(PTRDIFF_MAX) - page;
    static_assert(alignof(T) <= alignof(std::max_align_t));
};

// A vector whose `resize`, and whose constructor from a size, leave new values unset.
template <class T>
using LargeVector = std::vector<T, HugePages<T>>;

}  // namespace tyndall::radiosity
