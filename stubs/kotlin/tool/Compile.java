import java.io.PrintStream;
import java.nio.file.Files;
import java.nio.file.Path;
import org.jetbrains.kotlin.cli.common.ExitCode;
import org.jetbrains.kotlin.cli.jvm.K2JVMCompiler;

/**
 * Runs the Kotlin compiler once per file of arguments, one argument per line. A warm compiler takes a third of the
 * time.
 */
public final class Compile {
    private Compile() {}

    /**
     * Compiles each file, and stops at the first failure. A file after `!` must fail; the output of the compiler is
     * written next to it as `FILE.said`.
     */
    public static void main(String[] files) throws Exception {
        for (String file : files) {
            boolean fails = file.startsWith("!");
            Path path = Path.of(fails ? file.substring(1) : file);
            String[] arguments = Files.readAllLines(path).toArray(new String[0]);
            try (PrintStream said = fails ? new PrintStream(path + ".said", "UTF-8") : null) {
                ExitCode code = new K2JVMCompiler().exec(fails ? said : System.err, arguments);
                if (fails != (code == ExitCode.COMPILATION_ERROR) || !fails && code != ExitCode.OK) {
                    System.err.println(path + ": " + code);
                    System.exit(1);
                }
            }
        }
    }
}
