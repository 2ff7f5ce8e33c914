#include "server/net/connections.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <utility>

#include "server/net/give_way.h"
#include "server/net/open_files.h"
#include "server/net/socket_info.h"
#include "server/net/tcp_listen.h"

namespace traverse {
namespace {

// How often to look at the connections: while much comes in, and otherwise.
constexpr int kBusyMilliseconds = 10;
constexpr int kQuietMilliseconds = 100;
constexpr uint64_t kMuchBytes = 1 << 20;

// Pending bytes halve in this many seconds. Small endless traffic, such as the frames of health
// checks, does not add up; --idle_timeout ends a message that takes minutes.
constexpr double kHalfLifeSeconds = 30;

// What a message takes beside its bytes (headers, frames, TLS), and what a call may send before it
// learns of a refusal: the first window of its stream, which the server keeps from growing.
constexpr double kFraming = 1.01;
constexpr double kMessageOverhead = 1024;
constexpr double kFirstWindow = 68'000;

// Unused allowance of a message for its frames and headers is no licence to send more later.
constexpr double kMostCredit = -(256 << 10);

// Bytes pending without a job may belong to calls that have not been processed yet,
// for this long. This shows a flood of calls to other services, such as health
// checks.
constexpr auto kMoment = std::chrono::milliseconds(300);

// By then everything has come that a caller still sends for a job that was ended.
constexpr auto kOnItsWay = std::chrono::seconds(2);

// Time for the end of a job to take effect before its connection is cut.
constexpr auto kPatience = std::chrono::milliseconds(250);

// The work that a connection causes in addition to its calls, counted in calls: when it goes, gRPC
// may have as many to end as a connection may have streams.
constexpr double kWorkOfConnection = 50;

// With less pending, cutting a connection does not help when memory is short.
constexpr double kWorthCutting = 64 << 10;

}  // namespace

absl::StatusOr<std::unique_ptr<Connections>> Connections::Listen(const std::string& address,
                                                                 const ConnectionRules& rules,
                                                                 Hooks hooks) {
  absl::StatusOr<std::vector<int>> listeners = TcpListen(address);
  if (!listeners.ok()) return listeners.status();
  std::unique_ptr<Connections> made(new Connections(rules, std::move(hooks)));
  made->listeners_ = *std::move(listeners);
  made->port_ = PortOf(made->listeners_.front());
  made->stop_ = eventfd(0, EFD_CLOEXEC);
  return made;
}

Connections::~Connections() {
  StopListening();
  MutexLock lock(mutex_);
  for (auto it = table_.begin(); it != table_.end();) it = Cut(it);
}

void Connections::Start() {
  hand_over_.emplace(kHands, [this](int socket, int hand) {
    // Connections that have gone meanwhile cost nothing more.
    if (InfoOf(socket).ended) {
      shutdown(socket, SHUT_RDWR);
      close(socket);
    } else {
      hooks_.hand_over(socket, hand);
    }
  });
  thread_ = std::thread([this] { Serve(); });
}

void Connections::StopListening() {
  if (thread_.joinable()) {
    eventfd_write(stop_, 1);
    thread_.join();
    hand_over_->Stop([this](const std::string& peer) { CutPeer(peer); });
  }
  for (const int listener : listeners_) close(listener);
  listeners_.clear();
  if (stop_ >= 0) close(std::exchange(stop_, -1));
}

void Connections::Serve() {
  std::vector<pollfd> polled = {{stop_, POLLIN, 0}};
  for (const int listener : listeners_) polled.push_back({listener, POLLIN, 0});
  Clock::time_point next = Clock::now();
  bool busy = false;
  while (true) {
    const bool full = hand_over_->IsFull();
    for (size_t i = 1; i < polled.size(); ++i) {
      polled[i].events = static_cast<int16_t>(full ? 0 : POLLIN);
    }
    poll(polled.data(), polled.size(), busy || full ? kBusyMilliseconds : kQuietMilliseconds);
    if (polled[0].revents != 0) return;
    bool accepted = false;
    for (size_t i = 1; i < polled.size(); ++i) {
      if (polled[i].revents == 0) continue;
      AcceptAll(polled[i].fd);
      accepted = true;
    }
    // What a new connection sends at once is seen soon.
    if (accepted && !busy) {
      busy = true;
      next = Clock::now() + std::chrono::milliseconds(kBusyMilliseconds);
    }
    if (Clock::now() < next) continue;
    for (const auto& [peer, excess] : Look(busy)) Restrain(peer, excess);
    next = Clock::now() + std::chrono::milliseconds(kBusyMilliseconds);
  }
}

void Connections::AcceptAll(int listener) {
  while (!hand_over_->IsFull()) {
    const int socket = accept4(listener, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (socket < 0) {
      if (errno == EMFILE || errno == ENFILE) WaitForRoom();
      return;
    }
    SetUp(socket, rules_.peer_timeout);
    const std::string peer = PeerOf(socket);
    int ours = fcntl(socket, F_DUPFD_CLOEXEC, 0);
    if (ours < 0) {
      WaitForRoom();
      ours = fcntl(socket, F_DUPFD_CLOEXEC, 0);
    }
    {
      MutexLock lock(mutex_);
      const Clock::time_point now = Clock::now();
      const bool banned = !peer.empty() && offenders_.IsBanned(AddressOf(peer), now);
      if (banned || peer.empty() || ours < 0 || (IsFull() && !MakeRoom(peer))) {
        close(socket);
        if (ours >= 0) close(ours);
        if (banned) ++cut_;
        continue;
      }
      const auto [entry, is_new] = table_.try_emplace(peer);
      if (!is_new) close(entry->second.socket);
      entry->second = Connection();
      entry->second.socket = ours;
      entry->second.moved = now;
      offenders_.NoteWork(AddressOf(peer), kWorkOfConnection, now);
    }
    if (const std::string away = hand_over_->Add(socket, peer); !away.empty()) CutPeer(away);
  }
}

// For want of files.
void Connections::WaitForRoom() {
  if (const std::string away = hand_over_->TurnAway(); !away.empty()) CutPeer(away);
  {
    MutexLock lock(mutex_);
    MakeRoom("");
  }
  poll(nullptr, 0, kBusyMilliseconds);  // its files are closed in a moment
}

bool Connections::IsFull() const {
  const int most = PlacesFor(rules_.files_part, kFilesOfConnection, rules_.max_connections);
  return static_cast<int>(table_.size()) >= most;
}

// For a new one of `peer`, see GiveWay.
bool Connections::MakeRoom(const std::string& peer) {
  GiveWay<const std::string*> give_way;
  for (const auto& [other, connection] : table_) {
    give_way.Offer(&other, AddressOf(other), connection.moved, connection.jobs > 0);
  }
  const std::string* chosen = nullptr;
  if (!give_way.Choose(AddressOf(peer), Clock::now(), chosen)) return false;
  Cut(table_.find(*chosen));
  return true;
}

void Connections::CutPeer(const std::string& peer) {
  MutexLock lock(mutex_);
  if (const auto found = table_.find(peer); found != table_.end()) Cut(found);
}

Connections::Table::iterator Connections::Cut(Table::iterator connection) {
  // gRPC, which also has the socket, learns that it ended.
  shutdown(connection->second.socket, SHUT_RDWR);
  close(connection->second.socket);
  ++cut_;
  return table_.erase(connection);
}

// Returns how many bytes came since the last time.
uint64_t Connections::Update(Connection& connection, const SocketInfo& info) const {
  const uint64_t more = info.received - connection.received;
  if (more > 0) connection.moved = Clock::now();
  connection.received = info.received;
  connection.pending += static_cast<double>(more);
  return more;
}

int64_t Connections::Allowed(const Connection& connection) const {
  return rules_.stranger_bytes + connection.jobs * rules_.job_bytes;
}

bool Connections::IsLoud(Connection& connection, Clock::time_point now) const {
  if (connection.jobs > 0 || connection.pending <= static_cast<double>(rules_.quiet_bytes)) {
    if (connection.loud_since <= now) connection.loud_since = Clock::time_point();
    return false;
  }
  if (connection.loud_since == Clock::time_point()) connection.loud_since = now;
  return now - connection.loud_since > kMoment;
}

double Connections::AllPending() const {
  double all = 0;
  for (const auto& [peer, connection] : table_) all += std::max(0.0, connection.pending);
  return all;
}

std::string Connections::LargestHoarder() const {
  struct Address {
    double pending = 0;
    Table::const_iterator largest;
  };
  if (AllPending() <= static_cast<double>(rules_.all_bytes)) return "";
  std::map<std::string, Address> addresses;
  for (auto it = table_.begin(); it != table_.end(); ++it) {
    const double pending = std::max(0.0, it->second.pending);
    const auto [found, is_new] = addresses.try_emplace(AddressOf(it->first));
    Address& address = found->second;
    if (is_new || pending > address.largest->second.pending) address.largest = it;
    address.pending += pending;
  }
  const auto most = std::max_element(
      addresses.begin(), addresses.end(),
      [](const auto& a, const auto& b) { return a.second.pending < b.second.pending; });
  if (most->second.pending <= static_cast<double>(rules_.job_bytes)) return "";
  return most->second.largest->first;
}

std::vector<std::pair<std::string, Excess>> Connections::Look(bool& busy) {
  std::vector<std::pair<std::string, Excess>> offenders;
  uint64_t most = 0;
  MutexLock lock(mutex_);
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - looked_).count();
  const double fading = std::exp2(-seconds / kHalfLifeSeconds);
  // Where this thread was late, so may have been those that deliver what had come.
  const auto late = now - looked_ - std::chrono::milliseconds(kQuietMilliseconds);
  looked_ = now;
  for (auto it = table_.begin(); it != table_.end();) {
    Connection& connection = it->second;
    const SocketInfo info = InfoOf(connection.socket);
    if (!info.open) {
      close(connection.socket);
      it = table_.erase(it);
      continue;
    }
    connection.pending *= fading;
    if (late.count() > 0 && connection.loud_since != Clock::time_point()) {
      connection.loud_since += late;
    }
    most = std::max(most, Update(connection, info));
    connection.pending = std::max(kMostCredit, connection.pending);
    if (connection.pending > static_cast<double>(Allowed(connection)) || IsLoud(connection, now)) {
      offenders.emplace_back(it->first, Excess::kConnection);
    }
    ++it;
  }
  if (std::string hoarder = LargestHoarder(); !hoarder.empty()) {
    offenders.emplace_back(std::move(hoarder), Excess::kAddress);
  }
  offenders_.Tidy(now);
  busy = most > kMuchBytes;
  return offenders;
}

void Connections::Restrain(const std::string& peer, Excess excess) {
  {
    MutexLock lock(mutex_);
    const auto found = table_.find(peer);
    if (found == table_.end()) return;
    Connection& connection = found->second;
    const Clock::time_point now = Clock::now();
    const bool told = connection.complained != Clock::time_point();
    if (told && now - connection.complained < kPatience) return;
    if (told || connection.jobs == 0) {
      if (connection.jobs == 0) offenders_.NoteFlood(AddressOf(peer), IsLoud(connection, now), now);
      Cut(found);
      return;
    }
    connection.complained = now;
  }
  // Not under the lock: the end of a job calls back.
  if (hooks_.end_job(peer, excess)) {
    MutexLock lock(mutex_);
    const auto found = table_.find(peer);
    if (found == table_.end()) return;
    found->second.pending -= static_cast<double>(rules_.job_bytes);
    found->second.complained = Clock::time_point();
  }
}

void Connections::OnCall(const std::string& peer) {
  MutexLock lock(mutex_);
  const auto found = table_.find(PeerKey(peer));
  if (found == table_.end()) return;
  const std::string address = AddressOf(found->first);
  offenders_.NoteWork(address, 1, Clock::now());
  if (++found->second.calls <= rules_.max_calls) return;
  offenders_.NoteFlood(address, /*ban_at_once=*/true, Clock::now());
  Cut(found);
}

bool Connections::TurnAwayBusiest() {
  MutexLock lock(mutex_);
  const std::string address = offenders_.TakeBusiest(Clock::now());
  if (address.empty()) return false;
  offenders_.NoteFlood(address, /*ban_at_once=*/true, Clock::now());
  for (auto it = table_.begin(); it != table_.end();) {
    it = AddressOf(it->first) == address ? Cut(it) : std::next(it);
  }
  return true;
}

void Connections::OnCallDone(const std::string& peer) {
  MutexLock lock(mutex_);
  const auto found = table_.find(PeerKey(peer));
  if (found != table_.end()) found->second.calls = std::max(0, found->second.calls - 1);
}

void Connections::OnAuthorized(const std::string& peer) {
  MutexLock lock(mutex_);
  const auto found = table_.find(PeerKey(peer));
  // Below zero by what Look has not seen yet: it will.
  if (found != table_.end()) found->second.pending -= kFirstWindow;
}

double Connections::OnJob(const std::string& peer) {
  MutexLock lock(mutex_);
  const auto found = table_.find(PeerKey(peer));
  if (found == table_.end()) return 0;
  ++found->second.jobs;
  offenders_.NoteWork(AddressOf(found->first), -1, Clock::now());
  return std::max(0.0, found->second.pending);
}

void Connections::OnJobDone(const std::string& peer, double pending_before, bool all_came) {
  MutexLock lock(mutex_);
  const auto found = table_.find(PeerKey(peer));
  if (found == table_.end()) return;
  Connection& connection = found->second;
  if (!all_came) {
    // What came since the last look counts too. Which job it was for is unknown.
    if (const SocketInfo info = InfoOf(connection.socket); info.open) Update(connection, info);
    const double more = connection.pending - pending_before;
    if (more > 0) connection.pending -= more / std::max(1, connection.jobs);
  }
  connection.jobs = std::max(0, connection.jobs - 1);
  // A call that did not bring what it was to bring was no job.
  if (!all_came) offenders_.NoteWork(AddressOf(found->first), 1, Clock::now());
  // More of a job that the server has ended may be on its way.
  if (!all_came) connection.loud_since = Clock::now() + kOnItsWay;
}

void Connections::OnMessage(const std::string& peer, int64_t bytes) {
  MutexLock lock(mutex_);
  const auto found = table_.find(PeerKey(peer));
  if (found == table_.end()) return;
  found->second.pending -= static_cast<double>(bytes) * kFraming + kMessageOverhead;
}

bool Connections::CutLargest() {
  MutexLock lock(mutex_);
  const auto largest = std::max_element(
      table_.begin(), table_.end(),
      [](const auto& a, const auto& b) { return a.second.pending < b.second.pending; });
  if (largest == table_.end() || largest->second.pending < kWorthCutting) return false;
  Cut(largest);
  return true;
}

int Connections::open() const {
  MutexLock lock(mutex_);
  return static_cast<int>(table_.size());
}

int64_t Connections::pending_bytes() const {
  MutexLock lock(mutex_);
  return static_cast<int64_t>(AllPending());
}

uint64_t Connections::cut() const {
  MutexLock lock(mutex_);
  return cut_;
}

}  // namespace traverse
