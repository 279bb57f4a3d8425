// ArchiveFile: what libtorch serialises, as a file that is there whole or not at all; and the parts
// that checkpoints have in common.
#pragma once

#include <fmt/format.h>
#include <torch/torch.h>

#include <exception>
#include <filesystem>
#include <string>

#include "files/temporary_file.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::train {

/// Lets `fill` put its content into an archive, which is written under a temporary name and then
/// renamed. Fails with kIo, also where `fill` throws.
template <class Fill>
Result<void> write_archive(const std::filesystem::path& file, const Fill& fill) {
  const auto folder = files::Folder::make(file.parent_path());
  if (!folder) return folder.error();
  auto temporary = files::TemporaryFile::create(*folder, files::TemporaryKind::kSingle,
                                                file.filename().string());
  if (!temporary) return temporary.error();
  Result<void> written;
  try {
    torch::serialize::OutputArchive archive;
    fill(archive);
    archive.save_to([&](const void* data, std::size_t size) -> std::size_t {
      if (written) written = temporary->write({static_cast<const std::uint8_t*>(data), size});
      return size;
    });
  } catch (const std::exception& thrown) {
    return Error{ErrorCode::kIo, fmt::format("{}: expected a writable place, got \"{}\"; check the "
                                             "folder",
                                             file.string(), thrown.what())};
  }
  if (written) written = temporary->finish(Durability::kSynced);
  if (written) written = temporary->take_place();
  if (!written) return written;
  files::sweep(*folder, files::TemporaryKind::kSingle);
  return folder->sync(Durability::kSynced);
}

inline void put_text(torch::serialize::OutputArchive& archive, const std::string& key,
                     const std::string& text) {
  archive.write(key, c10::IValue(text));
}

inline std::string get_text(torch::serialize::InputArchive& archive, const std::string& key) {
  c10::IValue value;
  archive.read(key, value);
  return value.toStringRef();
}

inline std::int64_t get_whole(torch::serialize::InputArchive& archive, const std::string& key) {
  c10::IValue value;
  archive.read(key, value);
  return value.toInt();
}

/// Calls visit(name, tensor) for parameters and buffers; archives have no dots in their names.
template <class Visit>
void for_each_tensor(const torch::nn::Module& module, const Visit& visit) {
  const torch::NoGradGuard no_gradients;
  const auto named = [&](std::string name, torch::Tensor tensor) {
    for (char& letter : name) letter = letter == '.' ? '/' : letter;
    visit(name, tensor);
  };
  for (const auto& item : module.named_parameters()) named(item.key(), item.value());
  for (const auto& item : module.named_buffers()) named(item.key(), item.value());
}

inline void write_module(torch::serialize::OutputArchive& archive, const char* key,
                         const torch::nn::Module& module) {
  torch::serialize::OutputArchive inside;
  for_each_tensor(module, [&](const std::string& name, const torch::Tensor& tensor) {
    inside.write(name, tensor.detach().to(torch::kCPU));
  });
  archive.write(key, inside);
}

inline void read_module(torch::serialize::InputArchive& archive, const char* key,
                        const torch::nn::Module& module) {
  torch::serialize::InputArchive inside;
  archive.read(key, inside);
  for_each_tensor(module, [&](const std::string& name, torch::Tensor& tensor) {
    torch::Tensor saved;
    inside.read(name, saved);
    tensor.copy_(saved);
  });
}

/// What `read(archive)` makes of a checkpoint: a Result<State>. Fails with kIo where there is no
/// such file, with kBadInput where `read` throws, naming the command that writes them.
template <class State, class Read>
Result<State> read_archive(const std::filesystem::path& file, torch::Device device,
                           const char* writer, const Read& read) {
  if (!std::filesystem::is_regular_file(file)) {
    return Error{ErrorCode::kIo,
                 fmt::format("{}: expected a checkpoint; check the path", file.string())};
  }
  try {
    torch::serialize::InputArchive archive;
    archive.load_from(file.string(), device);
    return read(archive);
  } catch (const std::exception& thrown) {
    return Error{ErrorCode::kBadInput,
                 fmt::format("{}: expected a checkpoint of {}, got \"{}\"; start again or give "
                             "another file",
                             file.string(), writer, thrown.what())};
  }
}

}  // namespace flowdlo::train
