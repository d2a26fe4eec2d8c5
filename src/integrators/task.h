/// Coroutines that follow one path: an integrator reads like the textbook, and stops wherever it needs a ray
/// traced
/// (`co_await path.closest(ray)`), so that whoever runs it may trace many paths' rays together.
#pragma once

#include <coroutine>
#include <cstddef>
#include <exception>
#include <optional>
#include <utility>

#include "base/arena.h"

namespace alhazen {

class PathContext;

namespace task_detail {

Arena& arena_of(PathContext& path);

/// The path among a coroutine's arguments.
template <class First, class... Rest>
PathContext& find_path(First& first, Rest&... rest) {
    if constexpr (std::is_same_v<std::remove_cv_t<First>, PathContext>)
        return first;
    else
        return find_path(rest...);
}

} // namespace task_detail

/// A computation that yields a T. It starts at once and runs until it waits for a ray; where none has to be
/// waited for it is done before anybody awaits it, as a function call would be. Otherwise it resumes whoever
/// awaits it when done. One argument of the coroutine must be the PathContext&, whose arena holds the
/// coroutine's frame until the path ends; so a Task must not outlive its path. T must be trivially
/// destructible.
template <class T>
class [[nodiscard]] Task {
  public:
    struct promise_type {
        std::optional<T> value;
        std::coroutine_handle<> parent;

        Task get_return_object() { return Task(std::coroutine_handle<promise_type>::from_promise(*this)); }
        std::suspend_never initial_suspend() noexcept { return {}; }
        struct ResumeParent {
            bool await_ready() noexcept { return false; }
            std::coroutine_handle<> await_suspend(std::coroutine_handle<promise_type> done) noexcept {
                std::coroutine_handle<> awaiting = done.promise().parent;
                return awaiting ? awaiting : std::noop_coroutine();
            }
            void await_resume() noexcept {}
        };
        ResumeParent final_suspend() noexcept { return {}; }
        void return_value(T v) { value = std::move(v); }
        // Rendering does not throw; what is thrown all the same (out of memory) ends the program.
        void unhandled_exception() { std::terminate(); }

        template <class... Args>
        static void* operator new(std::size_t size, Args&... args) {
            return task_detail::arena_of(task_detail::find_path(args...)).allocate(size);
        }
        static void operator delete(void*, std::size_t) {} // the arena is reset when the path ends
    };

    Task(Task&& other) noexcept : handle_(std::exchange(other.handle_, {})) {}
    Task& operator=(Task&&) = delete;
    ~Task() {
        if (handle_) handle_.destroy();
    }

    bool await_ready() const noexcept { return handle_.done(); }
    void await_suspend(std::coroutine_handle<> parent) noexcept { handle_.promise().parent = parent; }
    T await_resume() { return std::move(*handle_.promise().value); }

    bool done() const { return handle_.done(); }
    const T& result() const { return *handle_.promise().value; }

  private:
    explicit Task(std::coroutine_handle<promise_type> handle) : handle_(handle) {}
    std::coroutine_handle<promise_type> handle_;
};

} // namespace alhazen
