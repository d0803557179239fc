#include "cli/commands.h"
#include "cli/manual.h"

namespace tyndall::cli {

void add_manual_command(Shell& shell) {
    shell.add_command("man", "The manual page tyndall(1), for man",
                      R"(  tyndall man > tyndall.1                      then: man ./tyndall.1)",
                      [&shell](const CommonFlags&) {
                          write_output(manual_page(shell.description()));
                          return 0;
                      });
}

}  // namespace tyndall::cli
