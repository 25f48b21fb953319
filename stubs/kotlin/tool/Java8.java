import java.io.InputStream;
import java.io.OutputStream;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.Collections;
import java.util.HashSet;
import java.util.Set;
import java.util.zip.ZipEntry;
import java.util.zip.ZipFile;
import java.util.zip.ZipOutputStream;

/**
 * Creates a jar of the API of Java 8, which every JDK contains for its compiler. Old ProGuard cannot read the classes
 * of a new JDK.
 */
public final class Java8 {
    private Java8() {}

    /** Writes the jar. */
    public static void main(String[] arguments) throws Exception {
        Path signatures = Path.of(System.getProperty("java.home"), "lib", "ct.sym");
        Set<String> written = new HashSet<>();
        try (ZipFile all = new ZipFile(signatures.toFile());
                OutputStream file = Files.newOutputStream(Path.of(arguments[0]));
                ZipOutputStream jar = new ZipOutputStream(file)) {
            for (ZipEntry entry : Collections.list(all.entries())) {
                int folder = entry.getName().indexOf('/');
                String name = entry.getName().substring(folder + 1).replaceAll("\\.sig$", ".class");
                boolean isOfEight = entry.getName().substring(0, Math.max(folder, 0)).contains("8");
                if (!isOfEight || !entry.getName().endsWith(".sig") || !written.add(name)) {
                    continue;
                }
                try (InputStream in = all.getInputStream(entry)) {
                    byte[] bytes = in.readAllBytes();
                    // The version of the class: 52, Java 8.
                    bytes[4] = 0;
                    bytes[5] = 0;
                    bytes[6] = 0;
                    bytes[7] = 52;
                    jar.putNextEntry(new ZipEntry(name));
                    jar.write(bytes);
                }
            }
        }
    }
}
