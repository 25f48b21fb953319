package course;

import fc.runtime.CallOptions;
import java.util.concurrent.CompletableFuture;
import java.util.concurrent.TimeUnit;
import odd_line.Client;
import odd_line.DriveRequest;
import odd_line.DriveResponse;
import odd_line.Going;
import odd_line.Tables;
import odd_line.WhenResponse;

/** The same package from Java: builders, futures, enums that Java can create. */
final class JavaCourse {
    private JavaCourse() {}

    @SuppressWarnings("deprecation")
    static void use(Client client) {
        DriveRequest request = DriveRequest.builder().val_(true).mood(Going.of("c")).secret("s").a(null).build();
        if (!request.toBuilder().name("n").build().getName().equals("n") || request.getMood() != Going.VALUE) {
            throw new AssertionError(request);
        }
        CompletableFuture<DriveResponse> driven = client.driveAsync(request, new CallOptions().timeout(1, TimeUnit.MINUTES));
        if (driven.join().getThere() == null) {
            throw new AssertionError(driven.join());
        }
        CompletableFuture<WhenResponse> asked = client.when_Async();
        if (asked.join().getList().isEmpty() || Tables.list().size() != 1) {
            throw new AssertionError(asked.join());
        }
    }
}
