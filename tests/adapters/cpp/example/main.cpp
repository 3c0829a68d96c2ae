// The program that `immaculate check` starts and asks.
//
//     immaculate check -- ./imm
//     immaculate check -- ./imm first_step=unmixed       a convention that is declared and followed

#include "adapter.hpp"

int main(int count, char **arguments) {
    immaculate::Program mine = program();
    for (const std::string &argument : std::vector<std::string>(arguments + 1, arguments + count)) {
        const std::size_t equals = argument.find('=');
        if (argument.substr(0, equals) != "first_step" || equals == std::string::npos) {
            std::cerr << argument << " is not known: the only convention to choose here is first_step=mixed, unmixed or predicted\n";
            return 2;
        }
        mine.conventions["first_step"] = argument.substr(equals + 1);
    }
    return immaculate::speak<Adapter>(mine);
}
