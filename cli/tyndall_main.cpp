// The program `tyndall`.

#include "cli/commands.h"

int main(int argc, char** argv) {
    tyndall::cli::Shell shell;
    tyndall::cli::add_all_commands(shell);
    return shell.run(argc, argv);
}
