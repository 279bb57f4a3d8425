// The records of a bag: an error, or a bag every message of which can be asked for.
#include <fstream>
#include <streambuf>

#include "promise.hpp"
#include "recording/bag.hpp"
#include "recording/bag_layout.hpp"
#include "target.hpp"
#include "working_folder.hpp"

namespace {

using flowdlo::fuzz::promise;
using flowdlo::recording::Bag;

/// Bytes in memory, to be read as a file is.
class ByteBuffer : public std::streambuf {
 public:
  ByteBuffer(const std::uint8_t* data, std::size_t size) {
    auto* begin = const_cast<char*>(reinterpret_cast<const char*>(data));
    setg(begin, begin, begin + size);
  }

 protected:
  pos_type seekoff(off_type offset, std::ios_base::seekdir from,
                   std::ios_base::openmode /*which*/) override {
    const auto base = from == std::ios_base::beg   ? eback()
                      : from == std::ios_base::cur ? gptr()
                                                   : egptr();
    const off_type target = base - eback() + offset;
    if (target < 0 || target > egptr() - eback()) return pos_type(off_type(-1));
    setg(eback(), eback() + target, egptr());
    return pos_type(target);
  }
  pos_type seekpos(pos_type position, std::ios_base::openmode which) override {
    return seekoff(off_type(position), std::ios_base::beg, which);
  }
};

void read_everything(const std::filesystem::path& file) {
  const auto bag = Bag::open(file);
  if (!bag) {
    promise(!bag.error().message.empty(), "an error has words");
    return;
  }
  for (const auto& topic : bag->topics()) {
    const auto stamps = bag->stamps({topic.name}, {});
    promise(!stamps || stamps->at(topic.name).size() == topic.messages,
            "every message has a stamp");
    for (std::size_t i = 0; i < topic.messages; ++i) {
      const bool image = bag->image(topic.name, i).has_value();
      const bool camera = bag->camera(topic.name, i).has_value();
      promise(!image || !camera, "a message is of one type");
    }
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const flowdlo::fuzz::WorkingFolder folder;
  ByteBuffer buffer(data, size);
  std::istream stream(&buffer);
  const auto sound = flowdlo::recording::check_bag_layout(stream, size, "a.bag");
  if (!sound) {
    promise(sound.error().message.starts_with("a.bag: "), "an error names its file");
    return 0;
  }
  const auto file = folder.path() / "a.bag";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  read_everything(file);
  return 0;
}
