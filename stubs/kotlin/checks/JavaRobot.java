package user;

import fc.runtime.Cadence;
import fc.runtime.ClientConfig;
import fc.runtime.Context;
import fc.runtime.Followed;
import fc.runtime.Following;
import fc.runtime.Server;
import fc.runtime.ServerConfig;
import java.util.Collections;
import java.util.concurrent.CompletableFuture;
import java.util.concurrent.CompletionException;
import meter.AsyncRobot;
import meter.Client;
import meter.CloseSwitchRequest;
import meter.CloseSwitchResponse;
import meter.Meter;
import meter.Operations;
import meter.PartialAsyncRobot;
import meter.ReadPowerRequest;
import meter.ReadPowerResponse;
import meter.RobotKt;
import meter.SetTariffRequest;
import meter.SetTariffResponse;
import meter.SwitchMoved;
import meter.WatchLoadRequest;
import meter.WatchLoadResponse;

/** A complete robot and a partial one in Java, and an app that follows a command. */
final class JavaRobot implements AsyncRobot {
    @Override
    public CompletableFuture<ReadPowerResponse> readPower(Context context, ReadPowerRequest request) {
        return CompletableFuture.completedFuture(ReadPowerResponse.Companion.example());
    }

    @Override
    public CompletableFuture<SetTariffResponse> setTariff(Context context, SetTariffRequest request) {
        return context.notImplemented().toFuture();
    }

    @Override
    public CompletableFuture<CloseSwitchResponse> closeSwitch(Context context, CloseSwitchRequest request) {
        return CompletableFuture.completedFuture(CloseSwitchResponse.Companion.example());
    }

    @Override
    public CompletableFuture<WatchLoadResponse> watchLoad(Context context, WatchLoadRequest request) {
        return CompletableFuture.completedFuture(WatchLoadResponse.Companion.example());
    }

    /** A robot with one command. */
    static final class Part implements PartialAsyncRobot {
        @Override
        public CompletableFuture<ReadPowerResponse> readPower(Context context, ReadPowerRequest request) {
            return CompletableFuture.completedFuture(ReadPowerResponse.Companion.example());
        }
    }

    public static void main(String[] arguments) throws Exception {
        Cadence.Step step = (Cadence.Step) Operations.priceMoved.getCadence();
        check(step.getField().equals("data.price") && step.getBy() == 0.5);
        check(((Cadence.Within) Operations.tariffSet.getCadence()).getMilliseconds() == 500);
        check(Operations.closeSwitch.getPreconditions().getAfter().equals(Collections.singletonList("read_power")));
        check(Operations.readPower.getPreconditions() == null);
        for (AsyncRobot robot : new AsyncRobot[] {new JavaRobot(), new Part()}) {
            ServerConfig served = new ServerConfig().address("127.0.0.1").commandPort(0).dataPort(0);
            try (Server server = Server.bind(Meter.INSTANCE, RobotKt.service(robot), served)) {
                ClientConfig app = new ClientConfig().host("127.0.0.1").commandPort(server.getCommandAddress().getPort());
                try (Client client = Client.connectAsync(app).join()) {
                    use(client, robot instanceof JavaRobot);
                }
            }
        }
    }

    private static void use(Client client, boolean isComplete) {
        check(client.readPowerAsync().join().equals(ReadPowerResponse.Companion.example()));
        try {
            client.setTariffAsync(SetTariffRequest.Companion.example()).join();
            check(false);
        } catch (CompletionException refused) {
            check(refused.getCause().getMessage().startsWith("refused"));
        }
        CompletableFuture<Following<CloseSwitchResponse, SwitchMoved>> called =
                client.closeSwitchFollowedAsync(CloseSwitchRequest.Companion.example(), new fc.runtime.CallOptions());
        if (!isComplete) {
            check(called.handle((following, failure) -> failure != null).join());
            return;
        }
        try (Following<CloseSwitchResponse, SwitchMoved> following = called.join()) {
            check(following.getAnswer().equals(CloseSwitchResponse.Companion.example()));
            CompletableFuture<Followed<SwitchMoved>> next = following.receiveAsync();
            check(!next.isDone());
        }
    }

    private static void check(boolean holds) {
        if (!holds) throw new AssertionError();
    }
}
