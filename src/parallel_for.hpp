// Loops over all cores.
#pragma once

#include <tbb/parallel_for.h>

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace insym {

/// body(i) for each i in [0, count), in any order, on the threads of the arena the caller is in.
template <typename Index, typename Body>
void parallel_for(Index count, const Body& body) {
#if defined(__SANITIZE_THREAD__)
    // The thread sanitizer sees no order in what TBB's library does, as that is not built for it. So
    // tell it: the call comes before every body, and every body before the return. The marks are
    // static, as a body may not even look at its captures before it has seen the first of them.
    static char begin = 0;
    static char end = 0;
    const auto marked = [&](Index i) {
        __tsan_acquire(&begin);
        body(i);
        __tsan_release(&end);
    };
    __tsan_release(&begin);
    tbb::parallel_for(Index{0}, count, marked);
    __tsan_acquire(&end);
#else
    tbb::parallel_for(Index{0}, count, body);
#endif
}

}  // namespace insym
