// The first call in Java, from both ends: as in Kotlin, with futures and listeners for coroutines.

import fc.Client;
import fc.Fc;
import fc.GetRobotSnRequest;
import fc.GetRobotSnResponse;
import fc.GetRobotSnResponseData;
import fc.PartialAsyncRobot;
import fc.RechargeError;
import fc.RechargeProgress;
import fc.RechargeProgressData;
import fc.RechargeStatus;
import fc.Reporter;
import fc.RobotKt;
import fc.runtime.Audience;
import fc.runtime.CallError;
import fc.runtime.ClientConfig;
import fc.runtime.Context;
import fc.runtime.Server;
import fc.runtime.ServerConfig;
import fc.runtime.Service;
import java.io.IOException;
import java.util.concurrent.CompletableFuture;
import java.util.concurrent.CompletionException;

public final class FirstCallInJava {
    private FirstCallInJava() {}

    // #region robot
    private static final class Mine implements PartialAsyncRobot {
        @Override
        public CompletableFuture<GetRobotSnResponse> getRobotSn(Context context, GetRobotSnRequest request) {
            GetRobotSnResponseData data =
                    GetRobotSnResponseData.builder().robotSn("100132007654321").build();
            GetRobotSnResponse response = GetRobotSnResponse.builder().data(data).build();
            return CompletableFuture.completedFuture(response);
        }
    }

    private static Service robot() {
        return RobotKt.service(new Mine());
    }
    // #endregion robot

    // #region app
    private static CompletableFuture<Void> app(Client client) {
        return client.getRobotSnAsync()
                .thenApply(answer -> answer.getData().getRobotSn())
                .thenAccept(number -> System.out.println("app: the robot is " + number));
    }
    // #endregion app

    // #region listen
    private static CompletableFuture<Void> listen(Client client) {
        CompletableFuture<RechargeProgress> first = new CompletableFuture<>();
        client.getConnection().onReport(report -> {
            if (report.getMessage() instanceof RechargeProgress) {
                first.complete((RechargeProgress) report.getMessage());
            }
        });
        return first.thenApply(progress -> progress.getData().getRechargeStatus())
                .thenAccept(status -> System.out.println("app: recharging is at " + status));
    }
    // #endregion listen

    private static RechargeProgress progress() {
        RechargeProgressData data =
                RechargeProgressData.builder()
                        .rechargeStatus(RechargeStatus.AT_UNDOCK_POINT)
                        .errorStatus(RechargeError.OK)
                        .build();
        return RechargeProgress.builder().data(data).build();
    }

    public static void main(String[] arguments) throws IOException {
        ServerConfig here = new ServerConfig().address("127.0.0.1").commandPort(0).dataPort(0);
        try (Server server = Server.bind(Fc.INSTANCE, robot(), here)) {
            int port = server.getCommandAddress().getPort();
            // #region connect
            ClientConfig config = new ClientConfig().host("127.0.0.1").commandPort(port);
            try (Client client = Client.connectAsync(config).join()) {
                app(client).join();
                // #endregion connect
                CompletableFuture<Void> listening = listen(client);
                Reporter reporter = new Reporter(server);
                int apps = reporter.rechargeProgressAsync(Audience.ALL, progress()).join().size();
                listening.join();
                System.out.println("robot: " + apps + " app has acknowledged");
                // #region error
            } catch (CompletionException failure) {
                if (!(failure.getCause() instanceof CallError)) throw failure;
                System.err.println("app: " + ((CallError) failure.getCause()).getName());
            }
            // #endregion error
        }
    }
}
