/// Tables that materials look up and that are costly to read or to compute: materials of one scene that need
/// the same share them.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <utility>

#include "base/made_once.h"
#include "materials/beam_diffusion.h"
#include "materials/measured_data.h"

namespace alhazen {

/// May be used from several threads. What materials hold outlives it.
class MaterialTables {
  public:
    /// Of a file of measurements, however its path is spelled. Throws std::runtime_error as read_file,
    /// TensorFile and MeasuredData do, to each who asks for it.
    std::shared_ptr<const MeasuredData> measured(const std::filesystem::path& file, ColorMode mode);
    /// As DiffusionTable takes them; not NaN.
    std::shared_ptr<const DiffusionTable> diffusion(float g, float eta);
    /// How many were made so far.
    std::size_t made() const { return made_; }

  private:
    MadeOnce<std::pair<std::filesystem::path, ColorMode>, MeasuredData> measured_;
    MadeOnce<std::pair<float, float>, DiffusionTable> diffusion_;
    std::atomic<std::size_t> made_ = 0;
};

} // namespace alhazen
