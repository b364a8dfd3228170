// What a handle of the C interface is.
#pragma once

#include "handle/contact.hpp"
#include "railpatch.h"

struct rp_contact {
  explicit rp_contact(const rp_config &config) : handle(config) {}
  railpatch::contact handle;
};
