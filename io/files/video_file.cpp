// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>
#include <type_traits>

#include <fcntl.h>
#include <spawn.h>
#include <sys/poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <penumbra/base/error.hpp>

#include <io/files/h264.hpp>
#include <io/files/numbers.hpp>
#include <io/files/printable.hpp>
#include <io/files/video_file.hpp>

namespace penumbra::io {

/// A running program whose output is read.
class ChildProgram {
 public:
  /// `patience`: how long read() and write() wait, milliseconds; nothing: without end, and the
  /// program has no input. Throws InputError if the program is not installed.
  explicit ChildProgram(std::vector<std::string> words, std::optional<int> patience = {})
      : patience_(patience.value_or(-1)) {
    std::array<int, 2> ends{}, input{-1, -1};
    // A socket, because writing to a pipe without a reader is a signal.
    if (::pipe2(ends.data(), O_CLOEXEC) != 0 ||
        (patience && ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, input.data()) != 0))
      throw std::bad_alloc();
    output_ = ends[0];
    input_ = input[0];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (patience)
      posix_spawn_file_actions_adddup2(&actions, input[1], STDIN_FILENO);
    else
      posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const int fault =
        ::posix_spawnp(&process_, pointers[0], &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (patience) ::close(input[1]);
    if (fault == 0) return;
    close_ends();
    throw InputError("videos need the program " + words.front() +
                     ", which cannot be run; install FFmpeg (Debian: apt install ffmpeg)");
  }
  ~ChildProgram() {
    close_ends();
    ::kill(process_, SIGKILL);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  /// Returns the number of bytes; fewer than wanted at the end, or after the patience.
  std::size_t read(char* to, std::size_t count) {
    std::size_t done = 0;
    while (done < count && wait(output_, POLLIN)) {
      const ssize_t got = ::read(output_, to + done, count - done);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) break;
      done += static_cast<std::size_t>(got);
    }
    return done;
  }

  /// Returns false if the program ended, or after the patience.
  bool write(std::string_view bytes) {
    while (!bytes.empty() && wait(input_, POLLOUT)) {
      const ssize_t taken = ::send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (taken < 0 && (errno == EINTR || errno == EAGAIN)) continue;
      if (taken < 0) break;
      bytes.remove_prefix(static_cast<std::size_t>(taken));
    }
    return bytes.empty();
  }

  /// Returns whether the last read() or write() ended by the patience.
  [[nodiscard]] bool is_silent() const { return is_silent_; }

 private:
  bool wait(int end, short event) {
    pollfd waited{end, event, 0};
    int ready = -1;
    do ready = ::poll(&waited, 1, patience_);
    while (ready < 0 && errno == EINTR);
    is_silent_ = ready == 0;
    return ready > 0;
  }
  void close_ends() const {
    ::close(output_);
    if (input_ >= 0) ::close(input_);
  }

  int patience_;
  int output_ = -1, input_ = -1;
  pid_t process_ = 0;
  bool is_silent_ = false;
};

namespace {

/// Returns what a program prints, at most 256 MB.
std::string output_of(std::vector<std::string> words) {
  constexpr std::size_t most = 256U << 20U;
  ChildProgram program(std::move(words));
  std::string text;
  for (std::size_t got = 1; got > 0 && text.size() < most;) {
    const std::size_t before = text.size();
    text.resize(before + (1U << 16U));
    got = program.read(text.data() + before, text.size() - before);
    text.resize(before + got);
  }
  return text;
}

/// Nothing but this file is opened, whatever it says.
std::vector<std::string> input_words(const std::filesystem::path& file) {
  return {"-protocol_whitelist", "file", "-i", "file:" + std::filesystem::absolute(file).string()};
}

std::vector<std::string> joined(std::vector<std::string> words,
                                const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// What ffprobe says of the first video stream.
struct VideoProbe {
  std::string pixels;  // ffmpeg's name of the format
  std::uint64_t width = 0, height = 0;
  std::vector<double> times;
};

VideoProbe probe_of(const std::filesystem::path& file) {
  std::istringstream lines(
      output_of(joined({"ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries",
                        "stream=width,height,pix_fmt:packet=pts_time,flags", "-of", "compact=nk=0"},
                       input_words(file))));
  VideoProbe found;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::string kind, field, flags;
    std::optional<double> time;
    std::getline(fields, kind, '|');
    while (std::getline(fields, field, '|')) {
      const std::size_t equals = field.find('=');
      const std::string key = field.substr(0, equals);
      const std::string value = equals == std::string::npos ? "" : field.substr(equals + 1);
      if (key == "width") found.width = parse_number<std::uint64_t>(value).value_or(0);
      if (key == "height") found.height = parse_number<std::uint64_t>(value).value_or(0);
      if (key == "pix_fmt") found.pixels = value;
      if (key == "flags") flags = value;
      if (key == "pts_time") time = parse_number<double>(value);
    }
    const bool is_shown = flags.find('D') == std::string::npos;  // else it is to be discarded
    // Without times, frames are shown as they are stored.
    if (kind == "packet" && is_shown)
      found.times.push_back(time.value_or(static_cast<double>(found.times.size())));
  }
  std::sort(found.times.begin(), found.times.end());
  return found;
}

}  // namespace

bool is_video_name(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  constexpr std::array<std::string_view, 6> known{".mp4", ".mkv", ".mov", ".avi", ".webm", ".m4v"};
  return std::find(known.begin(), known.end(), ending) != known.end();
}

template <typename T>
VideoFile<T>::VideoFile(const std::filesystem::path& file) : file_(file) {
  InputFile().open(file).require();
  const VideoProbe found = probe_of(file);
  if (found.times.empty() || found.width == 0)
    throw InputError(file.string() + ": holds no video that ffprobe can read");
  if (auto fault = check_image_size(found.width, found.height))
    throw InputError(file.string() + ": " + *fault);
  if (std::is_same_v<T, std::uint16_t> && !found.pixels.starts_with("gray16"))
    throw InputError(file.string() + ": holds " + found.pixels +
                     " pixels; depth needs 16-bit grey, as 'ffmpeg ... -c:v ffv1 -pix_fmt "
                     "gray16le' writes it");
  size_ = {static_cast<int>(found.width), static_cast<int>(found.height)};
  times_ = found.times;
}

template <typename T>
VideoFile<T>::~VideoFile() = default;

template <typename T>
void VideoFile<T>::start(std::size_t index) {
  decoder_.reset();
  std::vector<std::string> words{"ffmpeg",        "-nostdin", "-v", "quiet",
                                 "-noautorotate", "-threads", "1"};
  if (index > 0) {
    // Between two frames' times, so that rounding does not matter.
    std::ostringstream time;
    time << std::fixed << 0.5 * (times_[index - 1] + times_[index]);
    words = joined(std::move(words), {"-seek_timestamp", "1", "-ss", time.str()});
  }
  words = joined(std::move(words), input_words(file_));
  const char* const pixels = std::is_same_v<T, Rgb8> ? "rgb24" : "gray16le";
  decoder_ = std::make_unique<ChildProgram>(joined(
      std::move(words),
      {"-map", "0:v:0", "-vsync", "passthrough", "-f", "rawvideo", "-pix_fmt", pixels, "pipe:1"}));
  next_ = index;
}

template <typename T>
FileResult VideoFile<T>::read(std::size_t index, std::shared_ptr<const Image<T>>& image) {
  constexpr std::size_t most_skipped = 64, most_recent = 8;  // as many as are read at once
  const std::string name = "frame " + std::to_string(index);
  if (index >= frames())
    return {FileStatus::missing,
            file_.string() + ": has " + std::to_string(frames()) + " frames, and no " + name};
  const std::lock_guard lock(mutex_);
  for (const auto& [number, known] : recent_)
    if (number == index) {
      image = known;
      return {};
    }
  try {
    if (!decoder_ || index < next_ || index - next_ > most_skipped) start(index);
  } catch (const InputError& error) {
    return FileResult::bad(file_, error.what());
  }
  for (; next_ <= index; ++next_) {
    auto decoded = std::make_shared<Image<T>>(size_.width, size_.height);
    const std::size_t bytes = decoded->size() * sizeof(T);
    if (decoder_->read(reinterpret_cast<char*>(decoded->data()), bytes) != bytes) {
      decoder_.reset();
      return FileResult::bad(file_, name + " cannot be decoded");
    }
    recent_.emplace_back(next_, std::move(decoded));
    if (recent_.size() > most_recent) recent_.pop_front();
  }
  image = recent_.back().second;
  return {};
}

template class VideoFile<Rgb8>;
template class VideoFile<std::uint16_t>;

namespace {

constexpr const char* needs_later_frames =
    "the video has frames that need later ones; encode it without B-frames";

std::string little_endian(std::uint64_t value, int size) {
  std::string bytes;
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
  return bytes;
}

}  // namespace

VideoStream::VideoStream(int patience) : patience_(patience) {}

VideoStream::~VideoStream() = default;

std::string VideoStream::decode(std::string_view format, std::span<const std::byte> message,
                                Image<Rgb8>& image) {
  const std::string_view bytes(reinterpret_cast<const char*>(message.data()), message.size());
  if (format != "h264") return "the video has format '" + printable(format) + "'; expected h264";
  if (!refusal_.empty()) return refusal_;
  const H264Frame frame = read_h264(bytes, number_bits_);
  if (std::string fault = check(frame); !fault.empty()) return fault;
  if (frame.is_reference) last_ = frame.number;
  if (decoder_->write(little_endian(bytes.size(), 4) + little_endian(frames_++, 8)) &&
      decoder_->write(bytes) && read(image))
    return {};
  if (decoder_->is_silent() && frame.is_key)
    refusal_ = "ffmpeg gives no frame for a keyframe alone; encode the video without B-frames";
  decoder_.reset();
  return refusal_.empty() ? "the video's frame is damaged" : refusal_;
}

/// Returns why a frame cannot be decoded. Starts ffmpeg at the first keyframe, after faults, and
/// where the stream changes: ffmpeg would keep the size.
std::string VideoStream::check(const H264Frame& frame) {
  if (frame.pictures != 1)
    return "the video's message has " + std::to_string(frame.pictures) +
           " frames; expected one, in Annex B of H.264";
  const bool follows =
      frame.is_key || number_bits_ == 0 || frame.number == (last_ + 1) % (1U << number_bits_);
  if (frame.is_between || !follows) decoder_.reset();
  if (frame.is_between) return needs_later_frames;
  const bool can_start = frame.is_key && !frame.parameters.empty();
  if (can_start && (!decoder_ || frame.parameters != parameters_)) start(frame);
  if (decoder_ || !refusal_.empty()) return refusal_;
  return "the video's last keyframe, or a frame after it, is missing or damaged";
}

/// IVF delimits the messages, so that ffmpeg does not wait for the next one; PPM tells the size.
/// With -xerror ffmpeg ends at a damaged frame; else it would repair or skip it.
void VideoStream::start(const H264Frame& frame) {
  parameters_ = frame.parameters;
  std::istringstream words(
      "ffmpeg -nostdin -v quiet -xerror -threads 1 -flags low_delay"
      " -probesize 32 -analyzeduration 0 -fpsprobesize 0 -protocol_whitelist pipe -f ivf -i pipe:0"
      " -vsync passthrough -f image2pipe -c:v ppm -flush_packets 1 pipe:1");
  try {
    decoder_ = std::make_unique<ChildProgram>(
        std::vector<std::string>(std::istream_iterator<std::string>(words), {}), patience_);
    decoder_->write("DKIF" + little_endian(32U << 16U, 4) + "H264" + little_endian(0, 4) +
                    little_endian(1, 4) + little_endian(1, 4) + little_endian(0, 8));
  } catch (const InputError& error) {
    refusal_ = error.what();
  }
}

bool VideoStream::read(Image<Rgb8>& image) {
  constexpr std::size_t longest_header = 40;
  std::string header;
  for (int lines = 0; lines < 3; lines += header.back() == '\n' ? 1 : 0) {
    header += ' ';
    if (header.size() > longest_header || decoder_->read(&header.back(), 1) != 1) return false;
  }
  std::istringstream words(header);
  std::string kind;
  std::uint64_t width = 0, height = 0;
  words >> kind >> width >> height;
  if (check_image_size(width, height)) return false;
  image.fit(static_cast<int>(width), static_cast<int>(height));
  const std::size_t size = image.size() * sizeof(Rgb8);
  return decoder_->read(reinterpret_cast<char*>(image.data()), size) == size;
}

}  // namespace penumbra::io
