import java.io.PrintStream;
import java.nio.file.Files;
import java.nio.file.Path;
import org.jetbrains.kotlin.cli.common.ExitCode;
import org.jetbrains.kotlin.cli.jvm.K2JVMCompiler;

/** Runs the Kotlin compiler with each of some files of arguments, one to a line: a compiler that is warm takes a third of the time. */
public final class Compile {
    private Compile() {}

    /**
     * Compiles, and fails with the first that fails. What stands behind a `!` has to fail; what the compiler says of it goes to
     * a file beside it, `FILE.said`.
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
