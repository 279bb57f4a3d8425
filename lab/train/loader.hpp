// Loader: batches made ahead of the step that needs them, by threads of their own.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "train/batch.hpp"
#include "train/recipe.hpp"
#include "train/record_folder.hpp"

namespace flowdlo::train {

class Loader {
 public:
  /// Batches from `first_step` on. A batch depends on recipe, records and step alone, whatever the
  /// number of threads.
  Loader(std::shared_ptr<const RecordSet> records, const Recipe& recipe, const ViewConfig& view,
         std::uint64_t first_step, int threads);
  Loader(const Loader&) = delete;
  Loader& operator=(const Loader&) = delete;
  ~Loader();

  /// The next step's. Rethrows what making it threw.
  [[nodiscard]] Batch next();

 private:
  void work();

  std::shared_ptr<const RecordSet> records_;
  Recipe recipe_;
  ViewConfig view_;
  SamplePlan plan_;
  std::size_t ahead_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::uint64_t, Batch> ready_;
  std::uint64_t to_make_;
  std::uint64_t to_give_;
  bool ending_ = false;
  std::exception_ptr fault_;
  std::vector<std::thread> threads_;
};

}  // namespace flowdlo::train
