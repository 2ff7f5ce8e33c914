// The least that can be reproduced.

#ifndef TRAVERSE_TESTS_CLIENT_REPORT_REPRODUCE_TINY_FORM_H_
#define TRAVERSE_TESTS_CLIENT_REPORT_REPRODUCE_TINY_FORM_H_

#include "client/report/reproduce/figures_page.h"

namespace traverse::report {

inline ReproduceForm Tiny() {
  ReproduceForm form;
  form.seeds = 2;
  form.first_samples = 2;
  return form;
}

}  // namespace traverse::report

#endif  // TRAVERSE_TESTS_CLIENT_REPORT_REPRODUCE_TINY_FORM_H_
