/// What is costly to make and wanted more than once: made for the first who asks, shared by the others.
#pragma once

#include <map>
#include <memory>
#include <mutex>

namespace alhazen {

/// Things by key. May be used from several threads: those of different keys are made at the same time; who
/// wants one that another thread is making waits for it.
template <class Key, class T>
class MadeOnce {
  public:
    /// What make() gives, a std::shared_ptr<const T>, called once for a key unless it throws: then that comes
    /// out here, and the next who asks makes it anew. make() is called with a lock held: of the loops over
    /// threads it may run parallel_ranges alone.
    template <class Make>
    std::shared_ptr<const T> get(const Key& key, const Make& make) {
        std::unique_lock lock(mutex_);
        std::shared_ptr<Entry> entry = entries_.try_emplace(key, std::make_shared<Entry>()).first->second;
        lock.unlock();
        std::lock_guard making(entry->making);
        if (entry->made) return entry->made;
        std::shared_ptr<const T> made = make();
        lock.lock();
        entry->made = made;
        return made;
    }
    /// What is made already, else nullptr.
    std::shared_ptr<const T> find(const Key& key) const {
        std::lock_guard lock(mutex_);
        auto found = entries_.find(key);
        return found == entries_.end() ? nullptr : found->second->made;
    }
    /// Those who hold what is forgotten keep it.
    void forget(const Key& key) {
        std::lock_guard lock(mutex_);
        entries_.erase(key);
    }
    void forget_all() {
        std::lock_guard lock(mutex_);
        entries_.clear();
    }
    /// Calls visit(const T&) for all that is made, in the order of the keys; it must not ask for more.
    template <class Visit>
    void for_each(const Visit& visit) const {
        std::lock_guard lock(mutex_);
        for (const auto& [key, entry] : entries_)
            if (entry->made) visit(*entry->made);
    }

  private:
    struct Entry {
        std::mutex making;
        std::shared_ptr<const T> made; ///< written under both mutexes, read under one
    };
    mutable std::mutex mutex_;
    std::map<Key, std::shared_ptr<Entry>> entries_;
};

} // namespace alhazen
