#include "cli/commands.h"

namespace tyndall::cli {

void add_all_commands(Shell& shell) {
    add_new_command(shell);
    add_run_command(shell);
    add_check_command(shell);
    add_solve_command(shell);
    add_render_command(shell);
    add_view_command(shell);
    add_export_command(shell);
    add_probe_command(shell);
    add_exchange_command(shell);
    add_animate_command(shell);
    add_study_command(shell);
    add_compare_command(shell);
    add_completion_command(shell);
    add_manual_command(shell);
}

}  // namespace tyndall::cli
