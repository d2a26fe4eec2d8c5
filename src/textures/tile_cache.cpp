#include "textures/tile_cache.h"

#include <stdexcept>

namespace alhazen {

namespace {

void raise(std::atomic<std::size_t>& peak, std::size_t value) {
    std::size_t seen = peak.load();
    while (seen < value && !peak.compare_exchange_weak(seen, value)) {
    }
}

} // namespace

TileCache::TilePointer TileCache::get(std::uint64_t offset, std::size_t bytes) {
    Shard& shard = shards_[(offset * 0x9e3779b97f4a7c15u) >> 40 & (shards_.size() - 1)];
    if (TilePointer found = find(shard, offset)) return found;
    bytes_ += bytes;
    make_room();
    raise(peak_, bytes_);
    return insert(shard, read(offset, bytes));
}

TileCache::TilePointer TileCache::find(Shard& shard, std::uint64_t offset) {
    std::lock_guard lock(shard.mutex);
    auto place = shard.places.find(offset);
    if (place == shard.places.end()) return nullptr;
    shard.tiles.splice(shard.tiles.begin(), shard.tiles, place->second);
    return *place->second;
}

TileCache::TilePointer TileCache::insert(Shard& shard, TilePointer tile) {
    std::lock_guard lock(shard.mutex);
    auto [place, is_new] = shard.places.try_emplace(tile->offset);
    if (!is_new) { // another thread was faster
        bytes_ -= tile->bytes.size();
        return *place->second;
    }
    shard.tiles.push_front(tile);
    place->second = shard.tiles.begin();
    ++made_;
    return tile;
}

TileCache::TilePointer TileCache::read(std::uint64_t offset, std::size_t bytes) {
    auto tile = std::make_shared<Tile>(Tile{offset, std::vector<std::byte>(bytes)});
    try {
        file_.read(offset, tile->bytes);
    } catch (const std::exception& e) {
        // Rendering does not throw; who renders asks afterwards.
        std::lock_guard lock(mutex_);
        if (failure_.empty()) failure_ = e.what();
    }
    return tile;
}

void TileCache::make_room() {
    for (std::size_t tried = 0; tried < shards_.size() && bytes_ > limit_;)
        tried = drop_oldest(shards_[next_shard_++ % shards_.size()]) ? 0 : tried + 1;
}

bool TileCache::drop_oldest(Shard& shard) {
    std::lock_guard lock(shard.mutex);
    for (auto tile = shard.tiles.end(); tile != shard.tiles.begin();) {
        --tile;
        // Only under this lock does one pointer become two.
        if (tile->use_count() > 1) continue;
        bytes_ -= (*tile)->bytes.size();
        ++dropped_;
        shard.places.erase((*tile)->offset);
        shard.tiles.erase(tile);
        return true;
    }
    return false;
}

TextureMemory TileCache::memory() const {
    return {limit_, peak_, made_, dropped_, file_.size()};
}

void TileCache::throw_if_failed() const {
    std::lock_guard lock(mutex_);
    if (!failure_.empty()) throw std::runtime_error(failure_);
}

} // namespace alhazen
