// traverse-server as a process of its own, on ports that it chose.

#ifndef TRAVERSE_TESTS_SERVER_SUPPORT_SERVER_PROCESS_H_
#define TRAVERSE_TESTS_SERVER_SUPPORT_SERVER_PROCESS_H_

#include <string>
#include <vector>

#include "tests/support/child_process.h"

namespace traverse::testing {

class ServerProcess {
 public:
  explicit ServerProcess(const std::vector<std::string>& flags = {});

  ChildProcess& process() { return process_; }
  const std::string& address() const { return address_; }  // of the service

  int metrics_port() const { return metrics_port_; }

  // The body of an HTTP GET to the metrics port; `status` is that of the answer.
  std::string Get(const std::string& path, int* status = nullptr) const;

  // The value of a metric as scraped now; `name` with its labels. -1 if there is none.
  double Metric(const std::string& name) const;

 private:
  ChildProcess process_;
  std::string address_;
  int metrics_port_ = 0;
};

// HTTP/1.0 GET from a port of this machine.
std::string HttpGet(int port, const std::string& path, int* status);

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SERVER_SUPPORT_SERVER_PROCESS_H_
